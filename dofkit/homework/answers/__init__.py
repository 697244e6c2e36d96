"""Submissions: files and tables read, and the words in them."""
