"""The panel: the rules of its server, its bench, and the whole way in a browser."""
