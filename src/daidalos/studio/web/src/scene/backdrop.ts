// Sky and ground behind everything that is drawn: a gradient of the style sheet's kind, which costs no drawing.
import { Color } from "three";
import type { Look } from "./looks";

/** What a camera sees of the horizon. */
export interface Outlook {
  /** Angle below the horizon at which it looks [rad]. */
  pitch: number;
  /** Half of its field of view, upwards [rad]. */
  half: number;
  /** Its height above the ground [m]. */
  height: number;
  /** Its distance from what it looks at [m]. */
  reach: number;
}

/** Rows of the view with a colour of their own. */
const ROWS = 12;
/** At so many times the camera's reach the ground is half as clear as near it. */
const HAZE = 3;

/** The gradient that a camera sees behind the world; without an outlook, from straight above, the ground alone. */
export function gradientOf(look: Look, outlook: Outlook | undefined): string {
  if (!outlook) {
    return look.ground;
  }
  const rows = Array.from({ length: ROWS + 1 }, (_, i) => i / ROWS);
  const horizon = rowOf(0, outlook);
  if (horizon > 0 && horizon < 1) {
    rows.push(horizon);
  }
  const stops = rows.sort((a, b) => a - b).map((row) => `${colorAt(row, look, outlook)} ${(100 * row).toFixed(1)}%`);
  return `linear-gradient(${stops.join(", ")})`;
}

/** Where a direction is seen, by its angle above the horizon: 0 at the upper edge of the view and 1 at the lower. */
export function rowOf(elevation: number, { pitch, half }: Outlook): number {
  return (1 - Math.tan(elevation + pitch) / Math.tan(half)) / 2;
}

function colorAt(row: number, { zenith, horizon, ground }: Look, { pitch, half, height, reach }: Outlook): string {
  const elevation = Math.atan((1 - 2 * row) * Math.tan(half)) - pitch;
  if (elevation >= 0 || height <= 0) {
    return mixed(horizon, zenith, Math.sqrt(Math.max(0, Math.sin(elevation))));
  }
  const away = height / Math.tan(-elevation) / (HAZE * Math.max(0.1, reach));
  return mixed(ground, horizon, 1 - 1 / (1 + away * away));
}

/** A colour between two, as they look. */
function mixed(from: string, to: string, share: number): string {
  const [a, b] = [from, to].map((color) => new Color().setStyle(color, "")) as [Color, Color];
  return `#${a.lerp(b, share).getHexString("")}`;
}
