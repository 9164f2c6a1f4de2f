// window.daidalos: the page's state for end-to-end tests.
import { Vector3 } from "three";
import { MapDisplay } from "../displays/types/occupancy_grid";
import { PointsDisplay } from "../displays/points_display";
import type { Editor } from "../panels/simulation/editor";
import { Label } from "../scene/shapes";
import type { World } from "../scene/world";
import type { Studio } from "./studio";

export interface Pose2D {
  x: number;
  y: number;
  yaw: number;
}

export interface PageState {
  connected: boolean;
  serverName: string;
  topics: string[];
  fixedFrame: string;
  frames: string[];
  time: number | null;
  realTimeFactor: number | null;
  scanPoints: number;
  /** Width and height in cells, by the display's name. */
  maps: Record<string, [number, number]>;
  displays: Record<string, { level: string; text: string }>;
  robotPose: Pose2D | null;
  /** Whether the 3-D view no longer changes by itself. */
  settled: boolean;
  tool: string;
  /** The last message that the page published, by topic. */
  published: Record<string, unknown>;
  framesPerSecond: number;
  /** How often the 3-D view was drawn. */
  drawn: number;
}

export interface TestHooks {
  state(): PageState;
  /** Where a point of the fixed frame is in the window, in CSS pixels. */
  project(x: number, y: number, z?: number): { x: number; y: number } | null;
  takeTool(id: string): void;
  /** The labels of the 3-D view, in pixels of its canvas. */
  labels(): { text: string; left: number; right: number; top: number; bottom: number }[];
  /** Where a model of the simulation, or a link as model::link, is drawn in the window. */
  simulated(name: string): { x: number; y: number } | null;
  /** Whether the simulator has still to answer what was done in the Simulation panel. */
  editing(): boolean;
  /** Where the handle of the selected model in the simulation is in the window. */
  handle(axis: "x" | "y" | "z"): { x: number; y: number } | null;
}

declare global {
  interface Window {
    daidalos: TestHooks;
  }
}

let world: World | undefined;
let editor: Editor | undefined;

/** Give the hooks the 3-D view; returns how to remove it. */
export function attachWorld(attached: World): () => void {
  world = attached;
  return () => {
    if (world === attached) {
      world = undefined;
    }
  };
}

/** Give the hooks the simulation's editor; returns how to remove it. */
export function attachEditor(attached: Editor): () => void {
  editor = attached;
  return () => {
    if (editor === attached) {
      editor = undefined;
    }
  };
}

/** The 3-D view, while its panel is open. */
export function attachedWorld(): World | undefined {
  return world;
}

export function installTestHooks(studio: Studio): void {
  const published: Record<string, unknown> = {};
  const publish = studio.session.publish.bind(studio.session);
  studio.session.publish = (topic, type, message) => {
    published[topic] = message;
    publish(topic, type, message);
  };
  const meter = new FrameMeter(studio);
  window.daidalos = {
    state: () => ({ ...describe(studio), published, framesPerSecond: meter.rate }),
    project: (x, y, z = 0) => {
      if (!world) {
        return null;
      }
      const at = world.viewport.project(new Vector3(x, y, z));
      const box = world.viewport.canvas.getBoundingClientRect();
      return { x: box.left + at.x, y: box.top + at.y };
    },
    labels: () => labelsIn(world),
    takeTool: (id) => world?.toolbox.selectById(id),
    simulated: (name) => editor?.entityAt(name) ?? null,
    editing: () => editor?.isBusy ?? false,
    handle: (axis) => editor?.handleAt(axis) ?? null,
  };
}

function describe(studio: Studio): Omit<PageState, "published" | "framesPerSecond"> {
  const { session, fixedFrame, displays } = studio;
  const { time, factor } = studio.reading.value;
  const state: Omit<PageState, "published" | "framesPerSecond"> = {
    connected: session.link.value === "connected",
    serverName: session.serverName.value,
    topics: session.topics.value.map(({ name }) => name),
    fixedFrame: fixedFrame.current.value,
    frames: fixedFrame.frames.value,
    time: time ?? null,
    realTimeFactor: factor ?? null,
    scanPoints: 0,
    maps: {},
    displays: {},
    robotPose: robotPose(),
    drawn: world?.viewport.drawn ?? 0,
    settled: world?.isSettled ?? true,
    tool: world?.toolbox.active.value.id ?? "",
  };
  for (const { id, name } of displays.configs) {
    const display = displays.live.value.get(id);
    if (display) {
      state.displays[name] = display.status.value;
    }
    if (display instanceof PointsDisplay) {
      state.scanPoints += display.pointCount;
    } else if (display instanceof MapDisplay) {
      state.maps[name] = display.size;
    }
  }
  return state;
}

function labelsIn(world: World | undefined) {
  const found: { text: string; left: number; right: number; top: number; bottom: number }[] = [];
  const { viewport } = world ?? {};
  viewport?.scene.traverseVisible((object) => {
    if (object instanceof Label) {
      const { x, y } = viewport.project(object.position);
      const height = object.scale.y / viewport.view.metresPerPixel(object.position, viewport.height);
      const [left, bottom] = [x - object.center.x * height * object.ratio, y + object.center.y * height];
      found.push({ text: object.text, left, right: left + height * object.ratio, top: bottom - height, bottom });
    }
  });
  return found;
}

function robotPose(): Pose2D | null {
  const frame = world?.robotFrame();
  const pose = frame === undefined ? undefined : world?.poseOf(frame);
  return pose ? { x: pose.position.x, y: pose.position.y, yaw: pose.yaw } : null;
}

/** Frames of the screen per second, over the last second. */
class FrameMeter {
  rate = 0;
  private count = 0;
  private since = 0;

  constructor(studio: Studio) {
    studio.onFrame((page) => {
      this.count++;
      if (page - this.since >= 1) {
        this.rate = this.count / (page - this.since);
        [this.count, this.since] = [0, page];
      }
    });
  }
}
