"""What people achieved with things: typed events with evidence, kept and passed on.

Poses and skeletons come in (``service``), are gathered by object (``windows``) in a frame whose z
axis is up (``room``), and measured (``measures``: one file a family, functions on arrays). What is
settled is kept (``store``), published, and counted towards goals.
"""
