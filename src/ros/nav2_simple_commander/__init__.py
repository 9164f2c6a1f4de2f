"""Navigation for programs: `robot_navigator.BasicNavigator` sends a robot around, the rest looks into costmaps."""
