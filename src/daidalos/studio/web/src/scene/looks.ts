// What surrounds the world: colours of the sky and the ground, and strengths of the lights.

export interface Look {
  /** Colours of the sky overhead and at the horizon, and of the ground near the focus. */
  zenith: string;
  horizon: string;
  ground: string;
  /** Strength of the sun, of the light from all of the sky, and of the light against the sun. */
  sun: number;
  sky: number;
  fill: number;
  /** Colour of the light that the ground reflects upwards. */
  bounce: number;
  /** Opacity of shadows on the ground, 0 to 1. */
  shade: number;
  grid: string;
}

/** A bright studio with a blue sky, in which black robots and black walls stand out as well as white ones. */
export const DAYLIGHT: Look = {
  zenith: "#8fb8e6",
  horizon: "#f4f8fb",
  ground: "#ccd2d9",
  sun: 2.3,
  sky: 1.75,
  fill: 0.4,
  bounce: 0xb9b4ab,
  shade: 0.34,
  grid: "#8e99a6",
};

/** The same at dusk: for a dark page, lighter than the darkest robots and darker than laser scans. */
export const DUSK: Look = {
  zenith: "#1f2a3a",
  horizon: "#566377",
  ground: "#39424e",
  sun: 2.4,
  sky: 2.0,
  fill: 0.9,
  bounce: 0x8b919b,
  shade: 0.46,
  grid: "#8b97a6",
};
