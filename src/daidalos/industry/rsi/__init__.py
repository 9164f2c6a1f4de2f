"""KUKA's Robot Sensor Interface over Ethernet: telegrams, the controller's side simulated, and the program's side."""
