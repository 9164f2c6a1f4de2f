// What the page's address asks for: ?panel=turtlesim&window=/turtlesim/_window shows one panel as a window of its own.
import type { PanelType } from "../panels/panel";

export interface Opening {
  panel: PanelType;
  /** What else the address says, for the panel. */
  details: Record<string, string>;
}

const NOT_DETAILS = ["panel", "connect"];

/** The panel that an address names; undefined where it names none, or one that does not exist. */
export function readOpening(search: string, panels: readonly PanelType[]): Opening | undefined {
  const query = new URLSearchParams(search);
  const panel = panels.find(({ id }) => id === query.get("panel"));
  const details = Object.fromEntries([...query].filter(([name]) => !NOT_DETAILS.includes(name)));
  return panel && { panel, details };
}

/** The panel that an address wants to be in front of the others: ?front=simulation; undefined as above. */
export function readFront(search: string, panels: readonly PanelType[]): PanelType | undefined {
  const front = new URLSearchParams(search).get("front");
  return panels.find(({ id }) => id === front);
}
