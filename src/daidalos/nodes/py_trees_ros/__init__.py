"""Viewer of behaviour trees."""

EXECUTABLES = {"py-trees-tree-watcher": "tree_watcher"}
