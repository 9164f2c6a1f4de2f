"""Server of map files, and the program that saves maps, under their ROS 1 names."""
