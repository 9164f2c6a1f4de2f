"""Robotic grinding: a pneumatic actuator with an angle grinder, force control, removal and passes."""
