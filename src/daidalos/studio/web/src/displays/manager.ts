// Creates the displays of the configured list, updates and removes them.
import { effect, untracked } from "@preact/signals";
import { Box3, type Group } from "three";
import type { Display, Settings } from "../contract";
import type { Content } from "../scene/framing";
import { Display as PageDisplay, type DisplayContext, type FrameInfo } from "./display";
import { FailedDisplay } from "./failed_display";
import type { DisplayList } from "./list";
import { DISPLAYS } from "./registry";
import type { DisplayConfig } from "./settings";
import { RobotModel } from "./types/robot_model";

interface Made {
  display: Display;
  settings: Settings;
}

export class DisplayManager {
  private readonly made = new Map<string, Made>();
  private readonly stop: () => void;

  constructor(
    private readonly list: DisplayList,
    private readonly context: DisplayContext,
    private readonly parent: Group,
  ) {
    this.stop = effect(() => {
      const configs = list.configs;
      configs.forEach(({ type }) => DISPLAYS.find(type)); // packages may bring it later
      untracked(() => this.apply(configs));
    });
  }

  update(frame: FrameInfo): void {
    for (const [id, { display }] of this.made) {
      this.guard(id, () => display.update(frame));
    }
  }

  /** What there is to see, and the robots in it. */
  bounds(): Content {
    const all = new Box3();
    for (const { display } of this.made.values()) {
      if (display instanceof PageDisplay) {
        all.union(display.bounds());
      }
    }
    return { all, robot: this.robotBounds() };
  }

  /** The box around what robot displays show. */
  robotBounds(): Box3 {
    const robot = new Box3();
    for (const { display } of this.made.values()) {
      if (display instanceof RobotModel) {
        robot.union(display.bounds());
      }
    }
    return robot;
  }

  /** Create all displays again after time was reset or the server changed; latched messages are received again. */
  reset(): void {
    this.clear();
    this.apply(this.list.configs);
  }

  dispose(): void {
    this.stop();
    this.clear();
    this.publish();
  }

  private clear(): void {
    for (const { display } of this.made.values()) {
      display.dispose();
    }
    this.made.clear();
  }

  private apply(configs: readonly DisplayConfig[]): void {
    const wanted = new Map(configs.filter(({ enabled }) => enabled).map((config) => [config.id, config]));
    let changed = false;
    for (const [id, { display, settings }] of this.made) {
      const config = wanted.get(id);
      if (!config || config.settings.topic !== settings.topic) {
        display.dispose();
        this.made.delete(id);
        changed = true;
      }
    }
    for (const [id, config] of wanted) {
      const made = this.made.get(id);
      if (!made) {
        changed = this.make(config) || changed;
      } else if (made.settings !== config.settings) {
        made.settings = config.settings;
        this.guard(id, () => made.display.restyle(config.settings));
      }
    }
    if (changed) {
      this.publish();
    }
  }

  private make(config: DisplayConfig): boolean {
    const type = DISPLAYS.find(config.type);
    if (!type) {
      return false;
    }
    // Settings of an older version may lack some.
    const display = type.create(this.context, { ...type.defaults, ...config.settings });
    this.made.set(config.id, { display, settings: config.settings });
    this.parent.add(display.object);
    this.context.invalidate();
    return true;
  }

  /** Call a display; one that throws is replaced by one that reports the error. */
  private guard(id: string, run: () => void): void {
    try {
      run();
    } catch (error) {
      const made = this.made.get(id) as Made;
      made.display.object.removeFromParent();
      made.display = new FailedDisplay(error instanceof Error ? error.message : String(error));
      this.context.invalidate();
      this.publish();
    }
  }

  private publish(): void {
    this.list.live.value = new Map([...this.made].map(([id, { display }]) => [id, display]));
  }
}
