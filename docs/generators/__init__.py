"""Pages of the site that are made from the code; mkdocs runs these modules as hooks."""
