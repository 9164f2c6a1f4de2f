"""Moving heads that point at places of a work cell: kinematics, calibration, fixtures, DMX over Art-Net and sACN."""
