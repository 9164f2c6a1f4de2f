"""Bags: recorded messages in files of rosbag2's layout (metadata version 9, MCAP or sqlite3).

Plain files in, records out; nothing here knows of nodes or of message classes.
"""
