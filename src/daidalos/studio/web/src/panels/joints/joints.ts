// The joints of a joint_state_publisher_gui: parameters with limits, which the node's own services tell and set.
import { signal } from "@preact/signals";
import type { Session } from "../../connection/session";
import {
  type DescribeParameters,
  type GetParameters,
  type ListParameters,
  type ParameterEvent,
  ParameterType,
  type SetParameters,
} from "../../generated/rcl_interfaces";
import type { Empty } from "../../generated/std_srvs";
import type { Outgoing, ServiceType } from "../../contract";

const PREFIX = "joints.";
const KEEP = 32;
/** Descriptions of parameters end with the unit. */
const UNIT = /\[(\w+)\]$/;

export interface Joint {
  name: string;
  lower: number;
  upper: number;
  value: number;
  /** Empty where the node does not tell. */
  unit: string;
}

export class Joints {
  readonly joints = signal<readonly Joint[]>([]);
  readonly error = signal("");
  /** Positions that are not sent yet: one call is under way at a time, and the newest position wins. */
  private readonly unsent = new Map<string, number>();
  private isSending = false;

  constructor(
    private readonly session: Session,
    private readonly node: string,
  ) {}

  /** Follow the node until the returned function is called. */
  follow(): () => void {
    void this.read();
    return this.session.subscribe<ParameterEvent>("/parameter_events", KEEP, (event) => this.hear(event));
  }

  /** Put a joint somewhere. */
  set(name: string, value: number): void {
    this.take(new Map([[name, value]]));
    this.unsent.set(name, value);
    void this.send();
  }

  center(): void {
    void this.try(() => this.call<Empty>("center", {}));
  }

  randomize(): void {
    void this.try(() => this.call<Empty>("randomize", {}));
  }

  private async read(): Promise<void> {
    await this.try(async () => {
      const listed = await this.call<ListParameters>("list_parameters", { prefixes: ["joints"], depth: 0n });
      const names = listed.result.names.filter((name) => name.startsWith(PREFIX));
      const [described, got] = await Promise.all([
        this.call<DescribeParameters>("describe_parameters", { names }),
        this.call<GetParameters>("get_parameters", { names }),
      ]);
      this.joints.value = names.map((name, i) => {
        const range = described.descriptors[i]?.floating_point_range[0];
        return {
          name: name.slice(PREFIX.length),
          lower: range?.from_value ?? -Math.PI,
          upper: range?.to_value ?? Math.PI,
          value: got.values[i]?.double_value ?? 0,
          unit: UNIT.exec(described.descriptors[i]?.description ?? "")?.[1] ?? "",
        };
      });
    });
  }

  private hear({ node, new_parameters, changed_parameters, deleted_parameters }: ParameterEvent): void {
    if (node !== this.node) {
      return;
    }
    if ([...new_parameters, ...deleted_parameters].some(({ name }) => name.startsWith(PREFIX))) {
      void this.read(); // another robot
      return;
    }
    const changed = new Map<string, number>();
    for (const { name, value } of changed_parameters) {
      const joint = name.slice(PREFIX.length);
      // What the user's hand has moved on from is not shown again.
      if (name.startsWith(PREFIX) && !this.isSending && !this.unsent.has(joint)) {
        changed.set(joint, value.double_value);
      }
    }
    this.take(changed);
  }

  private take(values: ReadonlyMap<string, number>): void {
    if (values.size) {
      this.joints.value = this.joints.value.map((joint) => ({
        ...joint,
        value: values.get(joint.name) ?? joint.value,
      }));
    }
  }

  private async send(): Promise<void> {
    if (this.isSending) {
      return;
    }
    this.isSending = true;
    while (this.unsent.size) {
      const parameters = [...this.unsent].map(([name, double_value]) => ({
        name: PREFIX + name,
        value: { type: ParameterType.PARAMETER_DOUBLE, double_value },
      }));
      this.unsent.clear();
      await this.try(() => this.call<SetParameters>("set_parameters", { parameters }));
    }
    this.isSending = false;
  }

  private async try(work: () => Promise<unknown>): Promise<void> {
    try {
      await work();
      this.error.value = "";
    } catch (error) {
      this.error.value = error instanceof Error ? error.message : String(error);
    }
  }

  private call<S extends ServiceType>(service: string, request: Outgoing<S["Request"]>): Promise<S["Response"]> {
    return this.session.call<S>(`${this.node}/${service}`, request);
  }
}
