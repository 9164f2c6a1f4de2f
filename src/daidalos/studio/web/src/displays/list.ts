// The list of configured displays, kept in the browser, and the default one.
import { signal, type Signal } from "@preact/signals";
import { forget, isRecord, stored } from "../app/stored";
import type { Display, DisplayType, Settings, TopicInfo, Value } from "../contract";
import type { Registered } from "../registry";
import { DISPLAYS, displayFor } from "./registry";
import type { DisplayConfig } from "./settings";

const KEY = "displays";

const MAX_DISCOVERED = 24;
/** Intermediate plans of navigation repeat the plan: added, but disabled. */
const INTERMEDIATE_PLAN = /(received|transformed)_global_plan|(un)?smoothed/;

interface Saved {
  configs: DisplayConfig[];
  /** Topics for which a display was once added automatically; it is not added again after its removal. */
  seen: string[];
}

export class DisplayList {
  /** The displays in the scene, by id. */
  readonly live: Signal<ReadonlyMap<string, Display>> = signal(new Map());
  private readonly saved: Signal<Saved>;

  /** The displays of a file are not kept, and none are added automatically. */
  constructor(private readonly given?: readonly DisplayConfig[]) {
    const first = { configs: [...(given ?? firstConfigs())], seen: [] };
    this.saved = given ? signal<Saved>(first) : stored<Saved>(KEY, first, isSaved);
  }

  get configs(): readonly DisplayConfig[] {
    return this.saved.value.configs;
  }

  add(type: Registered<DisplayType>, topic?: string): void {
    const config = makeConfig(
      type,
      { ...(topic === undefined ? {} : { topic }) },
      topic ? shortName(topic) : undefined,
    );
    this.change([...this.configs, config]);
  }

  remove(id: string): void {
    this.change(this.configs.filter((config) => config.id !== id));
  }

  enable(id: string, enabled: boolean): void {
    this.edit(id, (config) => ({ ...config, enabled }));
  }

  set(id: string, key: string, value: Value): void {
    this.edit(id, (config) => ({ ...config, settings: { ...config.settings, [key]: value } }));
  }

  reset(): void {
    if (!this.given) {
      forget(KEY);
    }
    this.saved.value = { configs: [...(this.given ?? firstConfigs())], seen: [] };
  }

  /** Add displays for topics that no display shows. */
  discover(topics: readonly TopicInfo[]): void {
    if (this.given) {
      return;
    }
    const { configs, seen } = this.saved.peek();
    const shown = new Set(configs.map(({ settings }) => settings.topic));
    const found = topics.flatMap(({ name, type }) => {
      const display = displayFor(type);
      const isNew = display && display.discovery === "appears" && !shown.has(name) && !seen.includes(name);
      return isNew ? [{ display, name }] : [];
    });
    if (found.length && configs.length < MAX_DISCOVERED) {
      const made = found.map(({ display, name }) =>
        makeConfig(display, { topic: name, ...settingsOf(name) }, shortName(name), !INTERMEDIATE_PLAN.test(name)),
      );
      this.saved.value = { configs: [...configs, ...made], seen: [...seen, ...found.map(({ name }) => name)] };
    }
  }

  private edit(id: string, change: (config: DisplayConfig) => DisplayConfig): void {
    this.change(this.configs.map((config) => (config.id === id ? change(config) : config)));
  }

  private change(configs: DisplayConfig[]): void {
    this.saved.value = { ...this.saved.value, configs };
  }
}

/** The default displays, for a mobile robot; each is idle until its topic exists. */
function firstConfigs(): DisplayConfig[] {
  const entry = (type: string, name: string, settings: Settings = {}, enabled = true) => {
    const found = DISPLAYS.find(type);
    return found ? [makeConfig(found, settings, name, enabled)] : [];
  };
  return [
    ...entry("Grid", "Grid"),
    ...entry("Map", "Map", { topic: "/map" }),
    ...entry("Map", "Global costmap", { topic: "/global_costmap/costmap", scheme: "costmap", alpha: 0.35 }),
    ...entry("Map", "Local costmap", { topic: "/local_costmap/costmap", scheme: "costmap", alpha: 0.7 }),
    ...entry("RobotModel", "Robot"),
    ...entry("TF", "TF"),
    ...entry("LaserScan", "Laser scan"),
    ...entry("Path", "Plan", { topic: "/plan" }),
    ...entry("Path", "Local plan", { topic: "/local_plan", color: "#f5c451", width: 2.5, offset: 0.03 }),
    ...entry("Pose", "Goal"),
    ...entry("Polygon", "Footprint", { topic: "/local_costmap/published_footprint" }),
    ...entry("Odometry", "Odometry", {}, false),
  ];
}

/** The settings of a discovered topic whose name tells more than its type. */
function settingsOf(topic: string): Settings {
  return topic.includes("costmap") && !topic.includes("footprint") ? { scheme: "costmap", alpha: 0.5 } : {};
}

function makeConfig(type: Registered<DisplayType>, settings: Settings, name = type.id, enabled = true): DisplayConfig {
  return {
    id: crypto.getRandomValues(new Uint32Array(2)).join("-"),
    type: type.id,
    name,
    enabled,
    settings: { ...type.defaults, ...settings },
  };
}

function shortName(topic: string): string {
  return topic.replace(/^\//, "");
}

function isSaved(value: unknown): value is Saved {
  return (
    isRecord(value) &&
    Array.isArray(value.seen) &&
    Array.isArray(value.configs) &&
    value.configs.every(
      (config) =>
        isRecord(config) &&
        typeof config.id === "string" &&
        typeof config.name === "string" &&
        typeof config.enabled === "boolean" &&
        isRecord(config.settings) &&
        typeof config.type === "string",
    )
  );
}
