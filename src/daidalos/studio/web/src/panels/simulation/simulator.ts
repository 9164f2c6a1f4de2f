// A simulator in the graph, by the services of simulation_interfaces and daidalos_msgs.
import { signal } from "@preact/signals";
import type { Session } from "../../connection/session";
import type { BringBack, GetShapes, GetShapes_Response, InsertShape, ScaleEntity } from "../../generated/daidalos_msgs";
import type { ModelStates, PerformanceMetrics } from "../../generated/gazebo_msgs";
import type { Pose, Vector3 } from "../../generated/geometry_msgs";
import {
  type DeleteEntity,
  type GetSimulationState,
  type GetSpawnables,
  ResetSimulation_Request,
  type ResetSimulation,
  Result,
  type SetEntityState,
  type SetSimulationState,
  SimulationState,
  type SpawnEntity,
  type StepSimulation,
} from "../../generated/simulation_interfaces";
import type { ColorRGBA } from "../../generated/std_msgs";
import type { Outgoing, ServiceType } from "../../contract";

/** The service by which a simulator is recognized. */
export const SIMULATOR_TYPE = "simulation_interfaces/srv/SetSimulationState";
const KEEP = 1;

/** What Gazebo publishes of models and of links. */
export type EntityStates = Pick<ModelStates, "name" | "pose">;

export interface Resource {
  title: string;
  /** The model path, or a package. */
  origin?: string;
  uri: string;
  resource_string: string;
}

export class Simulator {
  readonly isPlaying = signal<boolean | undefined>(undefined);
  readonly spawnables = signal<Resource[]>([]);

  constructor(
    private readonly session: Session,
    /** The node's name. */
    readonly name: string,
  ) {}

  /** Follow its state; `tick` is called about once a second, also while the simulation is paused. */
  follow(states: (links: EntityStates) => void, tick: () => void): () => void {
    void this.readState();
    void this.readSpawnables();
    this.session.readParameters([this.speedParameter]);
    const stops = [
      this.session.subscribe<EntityStates>(`${this.name}/model_states`, KEEP, states),
      this.session.subscribe<EntityStates>(`${this.name}/link_states`, KEEP, states),
      this.session.subscribe<PerformanceMetrics>("/performance_metrics", KEEP, () => {
        void this.readState();
        tick();
      }),
    ];
    return () => stops.forEach((stop) => stop());
  }

  /** The real-time factor that is set; 0: as fast as possible. */
  get speed(): number | undefined {
    const value = this.session.parameters.value.get(this.speedParameter)?.value;
    return typeof value === "number" ? value : undefined;
  }

  setSpeed(value: number): void {
    this.session.setParameters([{ name: this.speedParameter, value, type: "float64" }]);
  }

  async play(on: boolean): Promise<void> {
    const state = on ? SimulationState.STATE_PLAYING : SimulationState.STATE_PAUSED;
    await this.call<SetSimulationState>("set_simulation_state", { state: { state } });
    this.isPlaying.value = on;
  }

  async step(steps: number): Promise<void> {
    await this.call<StepSimulation>("step_simulation", { steps: BigInt(steps) });
  }

  /** Reset time to zero and models to their initial states. */
  async reset(): Promise<void> {
    // Without SCOPE_SPAWNED: inserted models and the robot stay.
    const { SCOPE_TIME, SCOPE_STATE } = ResetSimulation_Request;
    await this.call<ResetSimulation>("reset_simulation", { scope: SCOPE_TIME | SCOPE_STATE });
  }

  async insert(shape: string, at: Vector3, size: number, mass: number, color: ColorRGBA): Promise<string> {
    const pose = upright({ ...at, z: at.z + size / 2 });
    const request = { shape, name: "", pose, size: { x: size, y: size, z: size }, mass, color };
    return (await this.call<InsertShape>("insert_shape", request)).name;
  }

  async spawn({ uri, resource_string }: Resource, at: Vector3): Promise<string> {
    const request = {
      name: "",
      allow_renaming: true,
      entity_resource: { uri, resource_string },
      entity_namespace: "",
      initial_pose: { header: { stamp: { sec: 0, nanosec: 0 }, frame_id: "" }, pose: upright(at) },
    };
    return (await this.call<SpawnEntity>("spawn_entity", request)).entity_name;
  }

  async move(entity: string, pose: Pose): Promise<void> {
    const zero = { x: 0, y: 0, z: 0 };
    // Gazebo's own service may have the standard one's name: the request is valid for both.
    const state = {
      name: entity,
      reference_frame: "",
      header: { stamp: { sec: 0, nanosec: 0 }, frame_id: "" },
      pose,
      twist: { linear: zero, angular: zero },
      acceleration: { linear: zero, angular: zero },
    };
    const request = { entity, state, set_pose: true, set_twist: true, set_acceleration: false };
    await this.call<SetEntityState>("set_entity_state", request);
  }

  async scale(name: string, { x, y, z }: Vector3): Promise<void> {
    await this.call<ScaleEntity>("scale_entity", { name, factors: { x, y, z } });
  }

  async remove(entity: string): Promise<void> {
    await this.call<DeleteEntity>("delete_entity", { entity });
  }

  /** Restore a deleted model. */
  async bringBack(name: string): Promise<void> {
    await this.call<BringBack>("bring_back", { name });
  }

  look(): Promise<GetShapes_Response> {
    return this.call<GetShapes>("get_shapes", { names: [] });
  }

  private get speedParameter(): string {
    return `${this.name}.real_time_factor`;
  }

  private async readState(): Promise<void> {
    const answer = await this.call<GetSimulationState>("get_simulation_state", {}).catch(() => undefined);
    this.isPlaying.value = answer && answer.state.state === SimulationState.STATE_PLAYING;
  }

  async readSpawnables(): Promise<void> {
    const answer = await this.call<GetSpawnables>("get_spawnables", { sources: [] }).catch(() => undefined);
    this.spawnables.value = (answer?.spawnables ?? []).map(({ entity_resource: { uri } }) => resourceAt(uri));
  }

  private async call<S extends ServiceType>(service: string, request: Outgoing<S["Request"]>): Promise<S["Response"]> {
    const answer = await this.session.call<S>(`${this.name}/${service}`, request);
    const errorText = errorOf(answer as Answer);
    if (errorText !== undefined) {
      throw new Error(errorText);
    }
    return answer;
  }
}

/** The resource of a URI, with a readable title. */
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

/** The error of a simulator's response; undefined where there is none. */
export function errorOf({ result, success, status_message }: Answer): string | undefined {
  if (result && result.result !== Result.RESULT_OK) {
    return result.error_message || `refused with code ${result.result}`;
  }
  return success === false ? status_message || "refused" : undefined;
}

function upright(position: Vector3): Pose {
  const { x, y, z } = position;
  return { position: { x, y, z }, orientation: { x: 0, y: 0, z: 0, w: 1 } };
}
