"""`python -m morfax`: the command line."""

import sys

from morfax.console.cli import main

sys.exit(main())
