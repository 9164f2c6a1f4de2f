// The order in which flat objects are drawn over each other; objects with a height are drawn after them.

export const Layer = {
  BEHIND: -60,
  MAP: -50,
  COSTMAP: -40,
  GRID: -30,
  SHADOW: -20,
  VEIL: 5,
  BODY: 6,
  LINE: 10,
  OUTLINE: 11,
  LINK: 20,
  TOOL: 30,
  LABEL: 40,
} as const;
