"""Programs of the two-armed robot ABB IRB 14000 YuMi."""
