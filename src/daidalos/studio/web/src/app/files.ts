// Files of layouts: opened into the page, and saved from it.
import type { Arrangement, Display } from "../generated/arrangement";
import { DISPLAYS } from "../displays/registry";
import type { DisplayConfig } from "../displays/settings";
import { firstCurves } from "../panels/plot/first_curves";
import type { ViewState } from "../scene/view";
import type { Layout } from "./layout";
import { plotSpan, plotTabs } from "./plots";
import { isRecord } from "./stored";
import type { Studio } from "./studio";

/** What the page opens with after it was loaded again; kept for this window. */
const OPENED = "daidalos.opened";
const FORMAT = "daidalos-layout";
const KEPT = ["layout", "displays", "view", "follow", "fixedFrame"] as const;
const PREFIX = "daidalos.";

export const ACCEPTED = ".rviz,.xml,.json";

/** Open a display configuration of RViz, a layout of PlotJuggler, or a layout of the page; rejected with the reason. */
export async function openFile(file: File): Promise<void> {
  const text = await file.text();
  if (/\.json$/i.test(file.name)) {
    takeLayout(file.name, text);
    location.search = "";
    return;
  }
  const answer = await fetch(`layouts/read?name=${encodeURIComponent(file.name)}`, { method: "POST", body: text });
  if (!answer.ok) {
    throw new Error(await answer.text());
  }
  const arrangement = (await answer.json()) as Arrangement;
  sessionStorage.setItem(OPENED, JSON.stringify({ name: file.name, arrangement }));
  const panel = arrangement.tabs.length ? "plot" : "scene";
  location.search = new URLSearchParams({ panel, layout: file.name }).toString();
}

/** The file that was opened in this window under a name, where one was. */
export function openedFile(name: string): Arrangement | undefined {
  try {
    const opened: unknown = JSON.parse(sessionStorage.getItem(OPENED) ?? "null");
    return isRecord(opened) && opened.name === name ? (opened.arrangement as unknown as Arrangement) : undefined;
  } catch {
    return undefined;
  }
}

/** Save what the 3-D view shows as a display configuration of RViz; rejected with the reason. */
export async function saveRviz(studio: Studio, view: ViewState | undefined, followed: string): Promise<void> {
  const displays = studio.displays.configs.map((config) => savedDisplay(config, studio.arrangement));
  const { arrangement, fixedFrame } = studio;
  const source = arrangement?.displays ? arrangement.source : "";
  await saveAs("daidalos.rviz", "layouts/rviz", {
    fixedFrame: fixedFrame.current.value,
    displays,
    view,
    followed,
    source,
  });
}

/** Save the plots as a layout of PlotJuggler; rejected with the reason. */
export async function savePlots(studio: Studio, { state }: Layout): Promise<void> {
  const tabs = plotTabs(state, firstCurves(studio));
  if (!tabs.length) {
    throw new Error("there is no plot to save");
  }
  const { arrangement } = studio;
  const source = arrangement?.tabs.length ? arrangement.source : "";
  await saveAs("daidalos.xml", "layouts/plotjuggler", { tabs, span: plotSpan(state), source });
}

/** Save what the server makes of a state, under the name of the file that was opened where it is of this kind. */
async function saveAs(name: string, address: string, state: object): Promise<void> {
  const answer = await fetch(address, { method: "POST", body: JSON.stringify(state) });
  const text = await answer.text();
  if (!answer.ok) {
    throw new Error(text);
  }
  const named = new URLSearchParams(location.search).get("layout");
  const suffix = name.slice(name.lastIndexOf("."));
  download(named?.endsWith(suffix) ? named : name, text);
}

/** A display without settings that neither its file nor the user gave: the page's defaults are not RViz's. */
function savedDisplay({ type, name, enabled, settings, origin = "" }: DisplayConfig, file?: Arrangement): Display {
  const given = file?.displays?.find((each) => each.origin === origin)?.settings;
  const defaults = DISPLAYS.find(type)?.defaults ?? {};
  const kept = Object.entries(settings).filter(([key, value]) => !given || key in given || value !== defaults[key]);
  return { type, name, enabled, settings: Object.fromEntries(kept), origin };
}

/** Save panels, displays and view as a file of the page's own. */
export function saveLayout(layout: unknown): void {
  const kept = Object.fromEntries(KEPT.map((key) => [key, localStorage.getItem(PREFIX + key)]));
  download("daidalos-layout.json", JSON.stringify({ format: FORMAT, version: 1, layout, kept }, undefined, 1));
}

function takeLayout(name: string, text: string): void {
  const file: unknown = JSON.parse(text);
  if (!isRecord(file) || file.format !== FORMAT || !isRecord(file.kept) || !isRecord(file.layout)) {
    throw new Error(`${name}: expected a layout that this page saved`);
  }
  for (const key of KEPT) {
    const value = file.kept[key];
    if (typeof value === "string") {
      localStorage.setItem(PREFIX + key, value);
    } else {
      localStorage.removeItem(PREFIX + key);
    }
  }
  localStorage.setItem(`${PREFIX}layout`, JSON.stringify(file.layout));
}

function download(name: string, text: string): void {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([text], { type: "text/plain" }));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href));
}
