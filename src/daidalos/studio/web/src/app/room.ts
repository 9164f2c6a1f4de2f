// How much room a window has for panels side by side.

/** Below this width there is no right column; what matters of it goes behind the displays. */
const NARROW_PX = 1200;
/** Below this width, that of a phone, all panels lie behind the view. */
const PHONE_PX = 640;

export type Room = "phone" | "narrow" | "wide";

export function roomOf(width: number): Room {
  return width < PHONE_PX ? "phone" : width < NARROW_PX ? "narrow" : "wide";
}
