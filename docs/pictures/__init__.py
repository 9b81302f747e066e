"""Make the pictures of the documents and the thumbnails of the page."""
