// A simulator in the graph: what the page asks of it, by simulation_interfaces and daidalos_msgs.
import { signal } from "@preact/signals";
import type { Session } from "../../connection/session";
import type { ColorRGBA, Marker, Pose, Vector3 } from "../../ros/messages";

/** The service by which a simulator is recognised. */
export const SIMULATOR_TYPE = "simulation_interfaces/srv/SetSimulationState";
const STATE = { stopped: 0, playing: 1, paused: 2 } as const;
const RESULT_OK = 1;
const KEEP = 1;
/** Without the scope of what was spawned: what the user put, and the robot, stay. */
const [SCOPE_TIME, SCOPE_STATE] = [1, 2] as const;

export interface EntityStates {
  name: string[];
  pose: Pose[];
}

export interface Looks {
  shapes: Marker[];
  entities: string[];
  poses: Pose[];
}

export interface Resource {
  title: string;
  /** Where it comes from: the model path, or a package. */
  origin?: string;
  uri: string;
  resource_string: string;
}

export class Simulator {
  readonly isPlaying = signal<boolean | undefined>(undefined);
  /** Simulated seconds per second, as the simulator measures it. */
  readonly factor = signal<number | undefined>(undefined);
  readonly spawnables = signal<Resource[]>([]);

  constructor(
    private readonly session: Session,
    /** The node's name. */
    readonly name: string,
  ) {}

  /** Follow its state; `beat` is called about once a second, also while time stands still. */
  follow(states: (links: EntityStates) => void, beat: () => void): () => void {
    void this.readState();
    void this.readSpawnables();
    this.session.readParameters([this.speedParameter]);
    const stops = [
      this.session.subscribe<EntityStates>(`${this.name}/model_states`, KEEP, states),
      this.session.subscribe<EntityStates>(`${this.name}/link_states`, KEEP, states),
      this.session.subscribe<{ real_time_factor: number }>("/performance_metrics", KEEP, (metrics) => {
        this.factor.value = metrics.real_time_factor;
        void this.readState();
        beat();
      }),
    ];
    return () => stops.forEach((stop) => stop());
  }

  /** How fast it is to run; 0 is as fast as possible. */
  get speed(): number | undefined {
    const value = this.session.parameters.value.get(this.speedParameter)?.value;
    return typeof value === "number" ? value : undefined;
  }

  setSpeed(value: number): void {
    this.session.setParameters([{ name: this.speedParameter, value, type: "float64" }]);
  }

  async play(on: boolean): Promise<void> {
    await this.call("set_simulation_state", { state: { state: on ? STATE.playing : STATE.paused } });
    this.isPlaying.value = on;
  }

  async step(steps: number): Promise<void> {
    await this.call("step_simulation", { steps: BigInt(steps) });
  }

  /** Begin anew: time at zero, every model where it came in. */
  async reset(): Promise<void> {
    await this.call("reset_simulation", { scope: SCOPE_TIME | SCOPE_STATE });
  }

  async insert(shape: string, at: Vector3, size: number, mass: number, color: ColorRGBA): Promise<string> {
    const pose = upright({ ...at, z: at.z + size / 2 });
    const request = { shape, name: "", pose, size: { x: size, y: size, z: size }, mass, color };
    return ((await this.call("insert_shape", request)) as { name: string }).name;
  }

  async spawn({ uri, resource_string }: Resource, at: Vector3): Promise<string> {
    const request = {
      name: "",
      allow_renaming: true,
      entity_resource: { uri, resource_string },
      entity_namespace: "",
      initial_pose: { header: { stamp: { sec: 0, nanosec: 0 }, frame_id: "" }, pose: upright(at) },
    };
    return ((await this.call("spawn_entity", request)) as { entity_name: string }).entity_name;
  }

  async move(entity: string, pose: Pose): Promise<void> {
    const zero = { x: 0, y: 0, z: 0 };
    // Gazebo's own service may have the standard one's name: what is asked is understood by both.
    const state = {
      name: entity,
      reference_frame: "",
      header: { stamp: { sec: 0, nanosec: 0 }, frame_id: "" },
      pose,
      twist: { linear: zero, angular: zero },
      acceleration: { linear: zero, angular: zero },
    };
    await this.call("set_entity_state", { entity, state, set_pose: true, set_twist: true, set_acceleration: false });
  }

  async scale(name: string, { x, y, z }: Vector3): Promise<void> {
    await this.call("scale_entity", { name, factors: { x, y, z } });
  }

  async remove(entity: string): Promise<void> {
    await this.call("delete_entity", { entity });
  }

  /** Put back what was deleted, as it was. */
  async bringBack(name: string): Promise<void> {
    await this.call("bring_back", { name });
  }

  async look(): Promise<Looks> {
    return (await this.call("get_shapes", { names: [] })) as Looks;
  }

  private get speedParameter(): string {
    return `${this.name}.real_time_factor`;
  }

  private async readState(): Promise<void> {
    const answer = (await this.call("get_simulation_state", {}).catch(() => undefined)) as
      { state: { state: number } } | undefined;
    this.isPlaying.value = answer && answer.state.state === STATE.playing;
  }

  async readSpawnables(): Promise<void> {
    const answer = (await this.call("get_spawnables", { sources: [] }).catch(() => undefined)) as
      { spawnables: { entity_resource: { uri: string } }[] } | undefined;
    this.spawnables.value = (answer?.spawnables ?? []).map(({ entity_resource: { uri } }) => resourceAt(uri));
  }

  private async call(service: string, request: object): Promise<unknown> {
    const answer = await this.session.call(`${this.name}/${service}`, request);
    const errorText = errorOf(answer as Answer);
    if (errorText !== undefined) {
      throw new Error(errorText);
    }
    return answer;
  }
}

/** What an address names, called as people call it. */
export function resourceAt(uri: string): Resource {
  const [scheme = "", path = ""] = uri.split("://");
  const file = uri.split("/").filter(Boolean).at(-1) ?? uri;
  const origin = scheme === "package" ? (path.split("/")[0] ?? "") : scheme === "model" ? "model" : "";
  return { title: file.replace(/\.(urdf|sdf|xml|xacro)/g, ""), origin, uri, resource_string: "" };
}

interface Answer {
  result?: { result: number; error_message: string };
  success?: boolean;
  status_message?: string;
}

/** Why a simulator did not do what it was asked; undefined where it did. */
export function errorOf({ result, success, status_message }: Answer): string | undefined {
  if (result && result.result !== RESULT_OK) {
    return result.error_message || `refused with code ${result.result}`;
  }
  return success === false ? status_message || "refused" : undefined;
}

function upright(position: Vector3): Pose {
  const { x, y, z } = position;
  return { position: { x, y, z }, orientation: { x: 0, y: 0, z: 0, w: 1 } };
}
