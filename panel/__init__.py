"""The operator's panel: a page in the browser over the same jobs as the command line.

The room holds a server (`app`, `guard`, `uploads`, `tiles`), the bench on which one drawing lies (`bench`,
`history`), the worker in a process of its own (`worker`, `workshop`) and the page itself (`page/`). It asks
`jobs` and `reports`; the verb `morfax panel` asks it, and hands it the command line's own parser
(`commands`).
"""
