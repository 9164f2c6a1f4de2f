"""Mock hardware; `daidalos.control.contracts` has the contract of hardware."""
