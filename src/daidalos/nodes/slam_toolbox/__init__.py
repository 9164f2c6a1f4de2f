"""Simultaneous localization and mapping, and localization in saved maps."""

COMPONENTS = {
    "AsynchronousSlamToolbox": "async_slam_toolbox_node:AsynchronousSlamToolbox",
    "SynchronousSlamToolbox": "sync_slam_toolbox_node:SynchronousSlamToolbox",
    "LocalizationSlamToolbox": "localization_slam_toolbox_node:LocalizationSlamToolbox",
    "LifelongSlamToolbox": "lifelong_slam_toolbox_node:LifelongSlamToolbox",
    "MapAndLocalizationSlamToolbox": "map_and_localization_slam_toolbox_node:MapAndLocalizationSlamToolbox",
}
