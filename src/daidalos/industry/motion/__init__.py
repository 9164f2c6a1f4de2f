"""Motion of industrial robots: kinematics of arms."""
