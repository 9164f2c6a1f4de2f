// One node of slam_toolbox, by its services: what it maps, saves, loads and lets people move.
import { signal } from "@preact/signals";
import type { Outgoing, Session, ServiceType } from "../../contract";
import type { Pose } from "../../generated/geometry_msgs";
import { Log } from "../../generated/rcl_interfaces";
import {
  type AddSubmap,
  type Clear,
  type ClearQueue,
  DeserializePoseGraph_Request,
  type DeserializePoseGraph,
  type LoopClosure,
  type MergeMaps,
  type Pause,
  SaveMap_Response,
  type SaveMap,
  SerializePoseGraph_Response,
  type SerializePoseGraph,
  type ToggleInteractive,
} from "../../generated/slam_toolbox";
import { type GetInteractiveMarkers, InteractiveMarkerFeedback } from "../../generated/visualization_msgs";

/** The services that show where such nodes are: of those that map or localize, and of the one that merges maps. */
const SIGNS: readonly (readonly [type: string, name: string])[] = [
  ["slam_toolbox/srv/Pause", "/pause_new_measurements"],
  ["slam_toolbox/srv/AddSubmap", "/add_submap"],
];
const KEEP = 32;
/** Number of lines that are shown. */
const SHOWN = 3;

/** A pose in the plane [m, rad]. */
export interface Pose2 {
  x: number;
  y: number;
  theta: number;
}

/** Where the robot is when a pose graph is loaded: at its first scan, at a pose, or to be localized near a pose. */
export type Start = "dock" | "pose" | "localize";

const MATCH_TYPES: Readonly<Record<Start, number>> = {
  dock: DeserializePoseGraph_Request.START_AT_FIRST_NODE,
  pose: DeserializePoseGraph_Request.START_AT_GIVEN_POSE,
  localize: DeserializePoseGraph_Request.LOCALIZE_AT_POSE,
};

/** What a node has done or refused, for people. */
export interface Report {
  text: string;
  /** As in messages of the log. */
  level: number;
}

/** The prefixes of the services of all such nodes, such as /slam_toolbox. */
export function slamNodes(services: Session["services"]["value"]): string[] {
  const found = services.flatMap(({ name, type }) =>
    SIGNS.filter(([sign, suffix]) => type === sign && name.endsWith(suffix)).map(([, suffix]) =>
      name.slice(0, -suffix.length),
    ),
  );
  return [...new Set(found)];
}

export class SlamNode {
  /** The latest lines of the node's log, which says more than its responses, and requests without success. */
  readonly reports = signal<readonly Report[]>([]);
  readonly isBusy = signal(false);
  /** The poses of the key scans, or of the submaps, that can be moved now, by their numbers. */
  readonly movable = signal<ReadonlyMap<number, Pose2>>(new Map());
  /** The namespace of their interactive markers. */
  private readonly markers: string;

  constructor(
    private readonly session: Session,
    readonly name: string,
  ) {
    this.markers = this.has("add_submap") ? name.replace(/[^/]*$/, "merge_maps_tool") : name;
  }

  /** Whether the node has a service. */
  has(service: string): boolean {
    return this.session.services.value.some(({ name }) => name === `${this.name}/${service}`);
  }

  /** Show what the node logs, until the returned function is called. */
  follow(): () => void {
    const logger = this.name.slice(1).replaceAll("/", ".");
    return this.session.subscribe<Log>("/rosout", KEEP, ({ name, level, msg }) => {
      if (name === logger && level >= Log.INFO) {
        this.add({ text: msg, level });
      }
    });
  }

  togglePause(): Promise<void> {
    return this.attempt(() => this.call<Pause>("pause_new_measurements", {}));
  }

  toggleInteractive(): Promise<void> {
    return this.attempt(() => this.call<ToggleInteractive>("toggle_interactive_mode", {}));
  }

  clearChanges(): Promise<void> {
    return this.attempt(async () => {
      await this.call<Clear>("clear_changes", {});
      await this.readMovable();
    });
  }

  applyChanges(): Promise<void> {
    return this.attempt(async () => {
      await this.call<LoopClosure>("manual_loop_closure", {});
      await this.readMovable();
    });
  }

  clearQueue(): Promise<void> {
    return this.attempt(() => this.call<ClearQueue>("clear_queue", {}));
  }

  saveMap(name: string): Promise<void> {
    return this.attempt(async () => {
      const { result } = await this.call<SaveMap>("save_map", { name: { data: name } });
      if (result !== SaveMap_Response.RESULT_SUCCESS) {
        const isMissing = result === SaveMap_Response.RESULT_NO_MAP_RECEIEVD;
        throw new Error(isMissing ? "there is no map to be saved yet" : `the map was not saved to ${name}`);
      }
    });
  }

  serialize(filename: string): Promise<void> {
    return this.attempt(async () => {
      const { result } = await this.call<SerializePoseGraph>("serialize_map", { filename });
      if (result !== SerializePoseGraph_Response.RESULT_SUCCESS) {
        throw new Error(`the pose graph was not saved to ${filename}`);
      }
    });
  }

  deserialize(filename: string, start: Start, pose: Pose2): Promise<void> {
    const request = { filename, match_type: MATCH_TYPES[start], ...(start === "dock" ? {} : { initial_pose: pose }) };
    return this.attempt(() => this.call<DeserializePoseGraph>("deserialize_map", request));
  }

  addSubmap(filename: string): Promise<void> {
    return this.attempt(async () => {
      await this.call<AddSubmap>("add_submap", { filename });
      await this.readMovable();
    });
  }

  mergeSubmaps(): Promise<void> {
    return this.attempt(() => this.call<MergeMaps>("merge_submaps", {}));
  }

  /** Ask what can be moved, and where it is. */
  showMovable(): Promise<void> {
    return this.attempt(() => this.readMovable());
  }

  /** Move a key scan or a submap, as an interactive marker that is dragged and let go. */
  move(number: number, pose: Pose2): void {
    for (const event_type of [InteractiveMarkerFeedback.POSE_UPDATE, InteractiveMarkerFeedback.MOUSE_UP]) {
      this.session.publish(`${this.markers}/feedback`, "visualization_msgs/msg/InteractiveMarkerFeedback", {
        client_id: "studio",
        marker_name: String(number),
        event_type,
        pose: toSpatial(pose),
      });
    }
    this.movable.value = new Map([...this.movable.peek(), [number, pose]]);
  }

  private async readMovable(): Promise<void> {
    const { markers } = await this.session.call<GetInteractiveMarkers>(`${this.markers}/get_interactive_markers`, {});
    this.movable.value = new Map(markers.map(({ name, pose }) => [Number(name), toPlanar(pose)]));
  }

  private call<S extends ServiceType>(service: string, request: Outgoing<S["Request"]>): Promise<S["Response"]> {
    return this.session.call<S>(`${this.name}/${service}`, request);
  }

  /** Show a line below the others. */
  add(report: Report): void {
    this.reports.value = [...this.reports.peek(), report].slice(-SHOWN);
  }

  private async attempt(work: () => Promise<unknown>): Promise<void> {
    const before = this.reports.peek();
    this.isBusy.value = true;
    try {
      await work();
    } catch (error) {
      // The reason that the node logged meanwhile is better than the number that it returned.
      if (!this.reports.peek().some((report) => report.level >= Log.WARN && !before.includes(report))) {
        this.add({ text: error instanceof Error ? error.message : String(error), level: Log.ERROR });
      }
    }
    this.isBusy.value = false;
  }
}

export function toPlanar({ position, orientation: { x, y, z, w } }: Pose): Pose2 {
  return { x: position.x, y: position.y, theta: Math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z)) };
}

export function toSpatial({ x, y, theta }: Pose2): Pose {
  return {
    position: { x, y, z: 0 },
    orientation: { x: 0, y: 0, z: Math.sin(theta / 2), w: Math.cos(theta / 2) },
  };
}
