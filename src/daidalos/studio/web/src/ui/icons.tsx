// The page's icons: strokes on a 24 × 24 grid, in the colour of the text around them.

const PATHS = {
  add: "M12 5v14M5 12h14",
  arrow: "M4 12h15M13 6l6 6-6 6",
  axes: "M6 18V5M6 18h13M6 18l7-6M4 7l2-2 2 2M17 16l2 2-2 2",
  camera: "M4 8h3l2-3h6l2 3h3v11H4zM12 16.5a3.5 3.5 0 1 0 0-7 3.5 3.5 0 0 0 0 7z",
  check: "M5 13l4.5 4.5L19 7",
  chevron: "M9 6l6 6-6 6",
  close: "M6 6l12 12M18 6L6 18",
  cloud: "M5 17h.01M9 14h.01M8 18h.01M12 17h.01M13 12h.01M16 15h.01M17 10h.01M19 18h.01M20 13h.01M12 8h.01",
  copy: "M9 9h10v11H9zM5 15V4h10",
  cube: "M12 3l8 4.5v9L12 21l-8-4.5v-9zM4 7.5l8 4.5 8-4.5M12 12v9",
  cylinder: "M5 6c0-4 14-4 14 0v12c0 4-14 4-14 0zM5 6c0 4 14 4 14 0",
  estimate:
    "M12 3a6 6 0 0 1 6 6c0 4.5-6 12-6 12S6 13.5 6 9a6 6 0 0 1 6-6zM12 11.5a2.5 2.5 0 1 0 0-5 2.5 2.5 0 0 0 0 5z",
  file: "M6 3h8l5 5v13H6zM14 3v5h5",
  filter: "M4 6h16M7 12h10M10 18h4",
  focus: "M12 15a3 3 0 1 0 0-6 3 3 0 0 0 0 6zM4 9V4h5M20 9V4h-5M4 15v5h5M20 15v5h-5",
  follow: "M12 2v4M12 18v4M2 12h4M18 12h4M12 17a5 5 0 1 0 0-10 5 5 0 0 0 0 10z",
  goal: "M6 21V4M6 4h12l-3 4 3 4H6",
  graph: "M3 6h6v5H3zM15 3h6v5h-6zM15 16h6v5h-6zM9 8.5h3V5.5h3M12 8.5v10h3",
  grid: "M4 4h16v16H4zM4 12h16M12 4v16",
  help: "M9 9a3 3 0 1 1 4.5 2.6c-1 .6-1.5 1.2-1.5 2.4M12 17.5h.01M12 22a10 10 0 1 0 0-20 10 10 0 0 0 0 20z",
  home: "M4 11l8-7 8 7v9h-5v-6H9v6H4z",
  image: "M4 5h16v14H4zM4 16l5-5 4 4 3-3 4 4M15.5 9.5h.01",
  layout: "M4 5h16v14H4zM10 5v14M10 13h10",
  link: "M5 12h14M7 15a3 3 0 1 1 0-6 3 3 0 0 1 0 6zM17 15a3 3 0 1 1 0-6 3 3 0 0 1 0 6z",
  log: "M5 6h14M5 10.5h14M5 15h9M5 19.5h6",
  map: "M4 6l5-2 6 2 5-2v14l-5 2-6-2-5 2zM9 4v14M15 6v14",
  marker: "M12 3l8 14H4zM8 21h8",
  measure: "M3 17L17 3l4 4L7 21zM7 13l2 2M10 10l2 2M13 7l2 2",
  message: "M5 5h14v10H9l-4 4z",
  minus: "M5 12h14",
  moon: "M20 14.5A8 8 0 0 1 9.5 4a8 8 0 1 0 10.5 10.5z",
  move: "M12 3v18M3 12h18M12 3l-3 3M12 3l3 3M12 21l-3-3M12 21l3-3M3 12l3-3M3 12l3 3M21 12l-3-3M21 12l-3 3",
  open: "M3 19V5h6l2 3h8v3M3 19l3-8h16l-3 8z",
  panel: "M4 5h16v14H4zM4 9h16",
  path: "M5 19c0-7 14-4 14-11M5 21a2 2 0 1 0 0-4 2 2 0 0 0 0 4zM19 8a2 2 0 1 0 0-4 2 2 0 0 0 0 4z",
  pause: "M8 5v14M16 5v14",
  play: "M7 5l12 7-12 7z",
  plot: "M4 4v16h16M7 15l4-5 3 3 5-7",
  point: "M12 20a8 8 0 1 0 0-16 8 8 0 0 0 0 16zM12 13.5a1.5 1.5 0 1 0 0-3 1.5 1.5 0 0 0 0 3z",
  polygon: "M12 3l8.5 6.5-3.2 10H6.7l-3.2-10z",
  reset: "M4 12a8 8 0 1 0 2.5-5.8M4 4v5h5",
  robot: "M6 9h12v10H6zM12 9V5M12 5h.01M9.5 13h.01M14.5 13h.01M10 16.5h4M3 12v4M21 12v4",
  save: "M5 4h11l3 3v13H5zM8 4v5h7V4M8 20v-6h8v6",
  scale: "M4 20V12M4 20h8M4 20L20 4M20 4v6M20 4h-6",
  scan: "M12 20V12M12 12l8-3M12 12L4 9M12 12l5-7M12 12L7 5M12 14a2 2 0 1 0 0-4 2 2 0 0 0 0 4z",
  search: "M10.5 17a6.5 6.5 0 1 0 0-13 6.5 6.5 0 0 0 0 13zM15.5 15.5L20 20",
  select: "M6 3l12 9-6 1-3 6z",
  sliders: "M5 8h8M17 8h2M5 16h2M11 16h8M15 10a2 2 0 1 0 0-4 2 2 0 0 0 0 4zM9 18a2 2 0 1 0 0-4 2 2 0 0 0 0 4z",
  sphere: "M12 21a9 9 0 1 0 0-18 9 9 0 0 0 0 18zM3 12c0 4 18 4 18 0",
  split: "M4 4h16v7H4zM4 14h16v6H4z",
  step: "M5 5l9 7-9 7zM18 5v14",
  sun: "M12 16a4 4 0 1 0 0-8 4 4 0 0 0 0 8zM12 2v2M12 20v2M2 12h2M20 12h2M5 5l1.4 1.4M17.6 17.6L19 19M5 19l1.4-1.4M17.6 6.4L19 5",
  tree: "M4 5h7M8 5v13h4M8 11.5h4M13 9.5h7v4h-7zM13 16h7v4h-7z",
  turn: "M19.5 9A8 8 0 1 0 20 13M20 4v5h-5",
  top: "M4 4h16v16H4zM8 8h8v8H8z",
  topics: "M5 7h.01M5 12h.01M5 17h.01M9 7h10M9 12h10M9 17h10",
  turtle:
    "M12 7.5c3 0 5 2 5 5s-2 6-5 7c-3-1-5-4-5-7s2-5 5-5zM12 7.5a2.2 2.2 0 1 1 0-4.4 2.2 2.2 0 0 1 0 4.4zM7.5 10.5C5 9 3.5 10 3 12.5M16.5 10.5C19 9 20.5 10 21 12.5M8.5 16.5L6.5 19.5M15.5 16.5l2 3M9.5 12.5h5M12 10v7",
  undo: "M9 6L4 11l5 5M4 11h10a6 6 0 0 1 0 12h-2",
  trash: "M5 7h14M10 7V4h4v3M7 7l1 13h8l1-13",
} as const;

export type IconName = keyof typeof PATHS;

/** The icon of a name, which may come from a module of another package. */
export function iconNamed(name: string | undefined, otherwise: IconName): IconName {
  return name !== undefined && name in PATHS ? (name as IconName) : otherwise;
}

export function Icon({ name, size = 16 }: { name: IconName; size?: number }) {
  return (
    <svg class="icon" width={size} height={size} viewBox="0 0 24 24" aria-hidden="true">
      <path d={PATHS[name]} />
    </svg>
  );
}
