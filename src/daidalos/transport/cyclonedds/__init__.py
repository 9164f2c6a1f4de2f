"""DDS in rmw_cyclonedds's wire format, on the library inside the `cyclonedds` package."""
