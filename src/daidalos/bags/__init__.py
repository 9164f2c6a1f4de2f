"""Bags: recorded messages in files, as ROS 2 lays them out (rosbag2, metadata version 9, MCAP or sqlite3).

Plain files in, records out; nothing here knows of nodes or of message classes.
"""
