// The query of the page's address: ?panel=turtlesim&window=/turtlesim/_window shows one panel as a window of its own.
import type { Panel } from "../contract";
import type { RegisteredPanel } from "../panels/registry";
import type { Registry } from "../registry";

export interface Opening {
  panel: RegisteredPanel;
  /** The other parameters of the query, for the panel. */
  details: Record<string, string>;
}

const NOT_DETAILS = ["panel", "connect"];

/** The panel that an address names; undefined where it names none, or one that does not exist. */
export function readOpening(search: string, panels: Registry<Panel>): Opening | undefined {
  const query = new URLSearchParams(search);
  const panel = panels.find(query.get("panel") ?? "");
  const details = Object.fromEntries([...query].filter(([name]) => !NOT_DETAILS.includes(name)));
  return panel && { panel, details };
}

/** The panel to bring to the front: ?front=simulation; undefined as above. */
export function readFront(search: string, panels: Registry<Panel>): RegisteredPanel | undefined {
  const front = new URLSearchParams(search).get("front");
  return panels.find(front ?? "");
}

/** Whether an address names a panel that is not there: an installed package may bring it. */
export function asksForMore(search: string, panels: Registry<Panel>): boolean {
  const query = new URLSearchParams(search);
  return ["panel", "front"].some((key) => query.has(key) && !panels.find(query.get(key) ?? ""));
}
