// The joints of a joint_state_publisher_gui: its parameters below "joints", with limits.
import { computed } from "@preact/signals";
import type { Session } from "../../contract";
import type { Empty } from "../../generated/std_srvs";
import { NodeParameters } from "../../parameters/node_parameters";

const PREFIX = "joints";

export interface Joint {
  name: string;
  lower: number;
  upper: number;
  value: number;
  /** Empty where the descriptor has none. */
  unit: string;
}

export class Joints {
  readonly joints = computed<readonly Joint[]>(() =>
    this.parameters.all.value.map(({ name, lower, upper, value, unit }) => ({
      name: name.slice(PREFIX.length + 1),
      lower: Number.isFinite(lower) ? lower : -Math.PI,
      upper: Number.isFinite(upper) ? upper : Math.PI,
      value: Number(value ?? 0),
      unit,
    })),
  );
  private readonly parameters: NodeParameters;

  constructor(session: Session, node: string) {
    this.parameters = new NodeParameters(session, node, PREFIX);
  }

  get error(): string {
    return this.parameters.error.value;
  }

  /** Follow the node until the returned function is called. */
  follow(): () => void {
    return this.parameters.follow();
  }

  /** Set a joint's position. */
  set(name: string, value: number): void {
    this.parameters.set(`${PREFIX}.${name}`, value);
  }

  center(): void {
    void this.parameters.attempt(() => this.parameters.call<Empty>("center", {}));
  }

  randomize(): void {
    void this.parameters.attempt(() => this.parameters.call<Empty>("randomize", {}));
  }
}
