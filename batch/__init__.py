"""Many drawings traced alike: a folder of results for each, on the cores of this computer or on a cluster.

The room finds the drawings (`search`), traces one into its folder (`one`), has that done by worker processes
that may die (`crew`, `worker`) or by a Dask cluster (`cluster`), and writes down how each ended (`manifest`).
It asks `jobs` and `reports`; the verb `morfax batch` asks it.
"""
