"""The sheet that students get: composed as Markdown, and set as a page, as a PDF or as LaTeX. It tells no answer."""
