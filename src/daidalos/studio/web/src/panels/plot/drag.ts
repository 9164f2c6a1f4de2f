// What is dragged from messages into plots: the path of a field.
export const PLOT_DRAG = "application/x-daidalos-field";
