// The docked panels: the default layout, and the user's, which is kept in the browser.
import { effect, signal, untracked } from "@preact/signals";
import {
  createDockview,
  type DockviewApi,
  type GroupPanelPartInitParameters,
  type IContentRenderer,
  type IDockviewPanel,
  type SerializedDockview,
} from "dockview-core";
import type { BuiltInPanel } from "../panels/panel";
import { PANELS, type RegisteredPanel } from "../panels/registry";
import type { PanelContext } from "../contract";
import type { Arrangement, Plot, Split } from "../generated/arrangement";
import type { DisplayConfig } from "../displays/settings";
import { PICTURE_PANELS } from "../displays/picture_display";
import { allPlots, firstPlot, isSplit } from "./arrangement";
import { showErrorLine } from "../ui/error_line";
import { ClosedPanels, type ClosedPanel } from "./closed_panels";
import { describeTabs } from "./dock_tabs";
import type { Opening } from "./opening";
import { type Room, roomOf } from "./room";
import { forget, isRecord, read, write } from "./stored";
import type { Studio } from "./studio";

const KEY = "layout";
/** Share of the 3-D view's width that plots beside it get. */
const BESIDE_SHARE = 0.4;
const THEME = { name: "daidalos", className: "dockview-theme-daidalos", gap: 6 };
const DISPLAYS_NARROW_PX = 250;
const IMAGE_PX = 300;
const BAG_PLAYER_PX = 120;
/** What the ids of panels of displays begin with. */
const PICTURE = "display:";

type Direction = "right" | "below";
interface Position {
  referencePanel: string;
  direction: Direction | "within";
}

export class Layout {
  private readonly dock: DockviewApi;
  private readonly key: string;
  private readonly kept = new Map<Room, SerializedDockview>();
  private readonly closed: ClosedPanels;
  private room = roomOf(window.innerWidth);
  private saving = 0;
  private isRearranging = false;

  constructor(
    private readonly element: HTMLElement,
    private readonly studio: Studio,
    private readonly opening?: Opening,
    private readonly front?: RegisteredPanel,
  ) {
    // A panel that is opened as a window has a layout of its own, and so has the page with a panel in front.
    this.key = opening ? `${KEY}.${opening.panel.id}` : front ? `${KEY}.front.${front.id}` : KEY;
    this.dock = createDockview(element, {
      theme: THEME,
      createComponent: ({ name }) => new PanelHost(name, studio),
      disableFloatingGroups: true,
    });
    this.closed = new ClosedPanels(this.dock, () => !this.isRearranging);
    this.restore();
    this.addAsked();
    if (front) {
      this.open(front);
    }
    describeTabs(element, this.dock);
    this.dock.onDidLayoutChange(() => this.saveSoon());
    this.watchPictures();
    addEventListener("pagehide", () => this.save());
    addEventListener("resize", () => this.followWidth());
  }

  /** The panel that was closed last; undefined: none can be opened again. */
  get lastClosed(): ClosedPanel | undefined {
    return this.closed.last.value;
  }

  /** Open the panel again that was closed last, where it was and with what it showed. */
  reopen(): void {
    const panel = this.closed.take();
    if (panel?.id.startsWith(PICTURE)) {
      this.studio.displays.enable(panel.id.slice(PICTURE.length), true);
    } else if (panel) {
      this.closed.open(panel);
    }
  }

  /** Show a panel: the one that is there, else a new one. */
  open(type: RegisteredPanel, params: Record<string, unknown> = {}, direction?: Direction): void {
    const present = this.dock.panels.find((panel) => panel.view.contentComponent === type.id);
    if (present && !type.many) {
      present.api.setActive();
      return;
    }
    const id = present ? `${type.id}-${crypto.getRandomValues(new Uint32Array(1)).join()}` : type.id;
    const reference = direction && this.dock.activePanel;
    const position = reference ? { position: { referencePanel: reference.id, direction } } : {};
    this.dock.addPanel({ id, component: type.id, title: type.title, params, ...position });
  }

  openById(id: string, params?: Record<string, unknown>, direction?: Direction): void {
    this.open(panelType(id), params, direction);
  }

  reset(): void {
    forget(this.roomKey);
    this.kept.clear();
    this.rearrange(() => this.dock.clear());
    this.arrange();
    this.showPictures(this.studio.displays.configs.filter(({ type, enabled }) => enabled && type in PICTURE_PANELS));
  }

  private restore(): void {
    if (this.opening && Object.keys(this.opening.details).length) {
      this.arrange(); // the address has precedence over the saved layout
      return;
    }
    if (!this.load(this.saved())) {
      this.arrange();
    }
  }

  private saved(): SerializedDockview | undefined {
    return read<SerializedDockview | undefined>(this.roomKey, undefined, (value): value is SerializedDockview =>
      isRecord(value),
    );
  }

  /** Take a layout that was saved; returns whether it could be used. */
  private load(saved: SerializedDockview | undefined): boolean {
    if (!saved) {
      return false;
    }
    try {
      this.dock.fromJSON(saved);
      return true;
    } catch (error) {
      console.warn("the saved layout cannot be used", error);
      this.dock.clear();
      return false;
    }
  }

  /** Where the layout of this width is kept. */
  private get roomKey(): string {
    return this.room === "wide" ? this.key : `${this.key}.${this.room}`;
  }

  /** Arrange the panels anew when the window has become a narrow one, a phone's, or a wide one again. */
  private followWidth(): void {
    const room = roomOf(window.innerWidth);
    if (room === this.room) {
      return;
    }
    this.save();
    this.kept.set(this.room, this.dock.toJSON());
    const open = this.dock.panels.map(({ id, title, params, view }) => ({
      id,
      title: title ?? "",
      component: view.contentComponent,
      params: params ?? {},
    }));
    this.room = room;
    this.rearrange(() => {
      if (!this.load(this.kept.get(room) ?? (this.studio.arrangement ? undefined : this.saved()))) {
        this.dock.clear();
        this.arrange();
      }
      for (const panel of this.dock.panels) {
        const before = open.find(({ id }) => id === panel.id);
        if (before) {
          panel.api.updateParameters(before.params);
        }
      }
      this.addMissing(open);
    });
  }

  /** Add panels that were open in a window of another width. */
  private addMissing(open: readonly ClosedPanel[]): void {
    const active = this.dock.activePanel;
    const reference = this.dock.getPanel("displays") ?? this.dock.panels[0];
    for (const panel of open.filter(({ id }) => !this.dock.getPanel(id))) {
      const position = reference ? { position: { referencePanel: reference.id } } : {};
      this.dock.addPanel({ ...panel, ...position, inactive: reference !== undefined });
    }
    active?.api.setActive();
  }

  private arrange(): void {
    // Sizes are shares of the dock's size, which must be known.
    this.dock.layout(this.element.clientWidth, this.element.clientHeight);
    if (this.opening) {
      this.arrangeWindow(this.opening);
    } else {
      this.arrangeRoom();
    }
  }

  private arrangeWindow({ panel, details }: Opening): void {
    const { id, title } = panel;
    document.title = `${title} · Daidalos`;
    const main = this.dock.addPanel({ id, component: id, title, params: details });
    const [beside, width] = (panel as Partial<BuiltInPanel>).beside ?? [];
    if (beside !== undefined && width !== undefined) {
      const direction = this.room === "phone" ? "within" : "left";
      const position = { referencePanel: id, direction } as const;
      this.dock.addPanel({ id: beside, component: beside, title: panelType(beside).title, position });
      main.api.setActive();
    }
    if (this.studio.arrangement) {
      this.arrangeAsAsked(this.studio.arrangement, main);
    }
    if (beside !== undefined && this.room !== "phone") {
      // Last, since plots beside the panel take their room from all others.
      this.dock.getPanel(beside)?.api.setSize({ width: width as number });
    }
  }

  /** Keep a panel for each display that is shown in one; closing the panel disables its display. */
  private watchPictures(): void {
    const { displays } = this.studio;
    effect(() => {
      const wanted = displays.configs.filter(({ type, enabled }) => enabled && type in PICTURE_PANELS);
      untracked(() => this.showPictures(wanted));
    });
    this.dock.onDidRemovePanel(({ id }) => {
      if (!this.isRearranging && id.startsWith(PICTURE)) {
        displays.enable(id.slice(PICTURE.length), false);
      }
    });
  }

  private showPictures(wanted: readonly DisplayConfig[]): void {
    this.rearrange(() => {
      for (const panel of this.dock.panels) {
        if (panel.id.startsWith(PICTURE) && !wanted.some(({ id }) => panel.id === PICTURE + id)) {
          this.dock.removePanel(panel);
        }
      }
    });
    for (const { id, type, name } of wanted) {
      if (!this.dock.getPanel(PICTURE + id)) {
        this.addPicture(PICTURE + id, PICTURE_PANELS[type] as string, name, { display: id });
      }
    }
  }

  private addPicture(id: string, component: string, title: string, params: Record<string, unknown>): void {
    const other = this.dock.panels.find((panel) => panel.id.startsWith(PICTURE));
    const beside = this.dock.getPanel("displays");
    const position: Position | undefined = other
      ? { referencePanel: other.id, direction: "within" }
      : beside && { referencePanel: beside.id, direction: "below" };
    const panel = this.dock.addPanel({ id, component, title, params, ...(position ? { position } : {}) });
    if (!other && beside) {
      panel.api.setSize({ height: Math.min(IMAGE_PX, 0.4 * this.element.clientHeight) });
    }
  }

  /** Change panels by the program: what is removed then was not closed by the user. */
  private rearrange(change: () => void): void {
    this.isRearranging = true;
    try {
      change();
    } finally {
      this.isRearranging = false;
    }
  }

  /** Open the panels that a file of RViz has besides the default ones. */
  private addAsked(): void {
    for (const id of this.studio.arrangement?.panels ?? []) {
      if (!this.dock.panels.some((panel) => panel.view.contentComponent === id)) {
        const beside = this.dock.getPanel("displays");
        const position = beside ? ({ referencePanel: beside.id, direction: "below" } as const) : undefined;
        this.dock.addPanel({ id, component: id, title: panelType(id).title, ...(position ? { position } : {}) });
      }
    }
  }

  /** What a file of PlotJuggler has in place of the first panel; beside it where that shows displays of the same layout. */
  private arrangeAsAsked({ tabs, span, displays }: Arrangement, main: IDockviewPanel): void {
    const [first, ...others] = tabs;
    if (first) {
      const plots = new PlotPlaces(this.dock, span);
      const direction = displays && this.room !== "phone" ? "right" : "within";
      const width = main.api.width;
      const panel = plots.add(first[0], firstPlot(first[1]), { referencePanel: main.id, direction });
      if (displays) {
        panel.api.setSize({ width: direction === "right" ? BESIDE_SHARE * width : width });
      } else {
        this.dock.removePanel(main);
      }
      others.forEach(([title, content]) => {
        for (const plot of allPlots(content)) {
          plots.add(title, plot, { referencePanel: panel.id, direction: "within" }, true);
        }
      });
      plots.fill(first[1], panel);
    }
  }

  private arrangeRoom(): void {
    const [width, height] = [window.innerWidth, window.innerHeight];
    const add = (id: string, beside?: string, direction: "within" | "left" | "right" | "below" = "within") =>
      this.dock.addPanel({
        id,
        component: id,
        title: panelType(id).title,
        inactive: direction === "within" && beside !== undefined,
        ...(beside === undefined ? {} : { position: { referencePanel: beside, direction } }),
      });
    const scene = add("scene");
    if (this.room === "phone") {
      ["displays", "topics", "message"].forEach((id) => add(id, "scene"));
      scene.api.setActive();
      return;
    }
    if (this.front?.id === "bag_player") {
      add("bag_player", "scene", "below").api.setSize({ height: BAG_PLAYER_PX });
    }
    const isSimulation = this.front?.id === "simulation";
    const displays = add(isSimulation ? "entities" : "displays", "scene", "left");
    if (isSimulation) {
      add("simulation", "scene");
      add("displays", "entities");
    }
    if (this.room === "narrow") {
      add("topics", displays.id);
      add("message", displays.id);
      displays.api.setSize({ width: DISPLAYS_NARROW_PX });
    } else {
      const topics = add("topics", "scene", "right");
      add("message", "topics");
      const plot = add("plot", "topics", "below");
      add("log", "plot");
      displays.api.setSize({ width: clamp(width * 0.19, DISPLAYS_NARROW_PX, 320) });
      topics.api.setSize({ width: clamp(width * 0.23, 280, 400) });
      plot.api.setSize({ height: clamp(height * 0.34, 200, 380) });
    }
    displays.api.setActive();
    scene.api.setActive();
  }

  /** The panels, to be saved in a file. */
  get state(): SerializedDockview {
    return this.dock.toJSON();
  }

  private saveSoon(): void {
    clearTimeout(this.saving);
    this.saving = window.setTimeout(() => this.save(), 300);
  }

  private save(): void {
    if (this.studio.arrangement) {
      return; // the file is read again next time
    }
    write(this.roomKey, this.dock.toJSON());
  }
}

/** Puts the plots of a file where it has them. */
class PlotPlaces {
  private number = 0;

  constructor(
    private readonly dock: DockviewApi,
    private readonly span: number,
  ) {}

  add(title: string, { curves, origin }: Plot, position: Position, inactive = false): IDockviewPanel {
    const id = `plot-${++this.number}`;
    const params = { curves, origin, ...(this.span ? { span: this.span } : {}) };
    return this.dock.addPanel({ id, component: "plot", title, params, position, inactive });
  }

  /** Divide a panel that shows the first plot of a split, so that it becomes all of the split. */
  fill(content: Plot | Split, panel: IDockviewPanel): void {
    if (!isSplit(content)) {
      return;
    }
    const [side, direction] = content.across ? (["width", "right"] as const) : (["height", "below"] as const);
    const room = panel.api[side];
    // First all parts beside each other, then what is within each: so that splits nest as they are written.
    const placed = [panel];
    for (const part of content.parts.slice(1)) {
      const referencePanel = (placed.at(-1) as IDockviewPanel).id;
      placed.push(this.add(panelType("plot").title, firstPlot(part), { referencePanel, direction }));
    }
    placed.forEach((each, i) => each.api.setSize({ [side]: (content.shares[i] ?? 0) * room }));
    content.parts.forEach((part, i) => this.fill(part, placed[i] as IDockviewPanel));
  }
}

function clamp(value: number, least: number, most: number): number {
  return Math.min(most, Math.max(least, value));
}

function panelType(id: string): RegisteredPanel {
  const found = PANELS.find(id);
  if (!found) {
    throw new Error(`there is no panel ${id}`);
  }
  return found;
}

/** Puts a panel into its place in the dock, once it is known: packages' panels come after the page's own. */
class PanelHost implements IContentRenderer {
  readonly element = document.createElement("div");
  private readonly visible = signal(false);
  private readonly stops: (() => void)[] = [];

  constructor(
    private readonly id: string,
    private readonly studio: Studio,
  ) {
    this.element.className = "panel";
    this.element.dataset.panel = id;
  }

  init({ api, params }: GroupPanelPartInitParameters): void {
    this.visible.value = api.isVisible;
    const watching = api.onDidVisibilityChange(({ isVisible }) => (this.visible.value = isVisible));
    const remember = (changed: Record<string, unknown>) => api.updateParameters(changed);
    const context: PanelContext = { studio: this.studio, visible: this.visible, params, remember };
    let isMounted = false;
    const stop = effect(() => {
      const panel = isMounted ? undefined : PANELS.find(this.id);
      if (panel) {
        isMounted = true;
        this.element.replaceChildren();
        const unmount = untracked(() => panel.mount(this.element, context));
        this.stops.push(() => unmount?.());
      } else if (!isMounted && PANELS.isComplete.value) {
        showErrorLine(this.element, `No installed package has a panel ${this.id}`);
      }
    });
    this.stops.push(stop, () => watching.dispose());
  }

  dispose(): void {
    this.stops.forEach((stop) => stop());
  }
}
