// Displays that are shown in a panel of their own beside the 3-D view.
import type { Settings } from "../contract";
import { Display, type DisplayContext } from "./display";
import { text } from "./settings";

/** The panels of displays, by the kinds of displays. */
export const PICTURE_PANELS: Readonly<Record<string, string>> = { Image: "image", Camera: "camera" };

export class PictureDisplay extends Display {
  constructor(context: DisplayContext, settings: Settings) {
    super(context, settings);
    const topic = text(settings, "topic");
    this.report(topic ? "ok" : "idle", topic ? "in a panel of its own" : "no topic chosen");
  }
}
