"""Qt's Python bindings, which are not part of this project: importing this package says what to use instead."""

raise ImportError(
    "python_qt_binding: there is no Qt here. The tools of rqt are pages of the studio (`ros2 run rqt_gui rqt_gui`);"
    " `daidalos extensions` says how packages add panels to it. For windows of your own, `pip install PySide6` and"
    " import PySide6.",
    name=__name__,
)
