"""Behavior trees: files of BehaviorTree.CPP, run by py_trees, with Nav2's nodes."""
