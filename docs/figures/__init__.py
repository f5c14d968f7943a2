"""The pictures of these pages, drawn by morfax itself: `python -m docs.figures [FOLDER]`."""
