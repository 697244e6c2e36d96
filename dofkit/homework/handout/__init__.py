"""The sheet that students get, without answers: composed as Markdown, and written as Markdown or as HTML."""
