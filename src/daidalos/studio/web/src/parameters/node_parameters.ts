// The parameters of a node: read, set and followed by the node's own services.
import { signal } from "@preact/signals";
import type { Outgoing, ServiceType, Session } from "../contract";
import type {
  DescribeParameters,
  GetParameters,
  ListParameters,
  ParameterEvent,
  SetParameters,
} from "../generated/rcl_interfaces";
import { describe, fromMessage, type Parameter, toMessage, type Value } from "./values";

const KEEP = 32;

export class NodeParameters {
  readonly all = signal<readonly Parameter[]>([]);
  /** Why the last request had no success; empty where it had. */
  readonly error = signal("");
  /** Values that are not sent yet: one call is under way at a time, and the newest value wins. */
  private readonly unsent = new Map<string, Value>();
  private isSending = false;

  /** `prefix`: only the parameters below it, such as "joints". */
  constructor(
    private readonly session: Session,
    private readonly node: string,
    private readonly prefix = "",
  ) {}

  /** Follow the node until the returned function is called. */
  follow(): () => void {
    void this.attempt(() => this.read());
    return this.session.subscribe<ParameterEvent>("/parameter_events", KEEP, (event) => this.receive(event));
  }

  set(name: string, value: Value): void {
    this.take(new Map([[name, value]]));
    this.unsent.set(name, value);
    void this.send();
  }

  call<S extends ServiceType>(service: string, request: Outgoing<S["Request"]>): Promise<S["Response"]> {
    return this.session.call<S>(`${this.node}/${service}`, request);
  }

  /** Run a request; why it fails is shown to the user. */
  async attempt(work: () => Promise<unknown>): Promise<void> {
    try {
      await work();
      this.error.value = "";
    } catch (error) {
      this.error.value = error instanceof Error ? error.message : String(error);
    }
  }

  private async read(): Promise<void> {
    const prefixes = this.prefix ? [this.prefix] : [];
    const listed = await this.call<ListParameters>("list_parameters", { prefixes, depth: 0n });
    const names = listed.result.names.filter((name) => this.covers(name));
    const [described, got] = await Promise.all([
      this.call<DescribeParameters>("describe_parameters", { names }),
      this.call<GetParameters>("get_parameters", { names }),
    ]);
    this.all.value = names.flatMap((name, i) => {
      const value = got.values[i];
      return value ? [describe(name, value, described.descriptors[i])] : [];
    });
  }

  private receive({ node, new_parameters, changed_parameters, deleted_parameters }: ParameterEvent): void {
    if (node !== this.node) {
      return;
    }
    if ([...new_parameters, ...deleted_parameters].some(({ name }) => this.covers(name))) {
      void this.attempt(() => this.read());
      return;
    }
    // Older values than the user's last one are not shown.
    const others = changed_parameters.filter(({ name }) => !this.isSending && !this.unsent.has(name));
    this.take(new Map(others.map(({ name, value }) => [name, fromMessage(value)])));
  }

  private covers(name: string): boolean {
    return !this.prefix || name.startsWith(`${this.prefix}.`);
  }

  private take(values: ReadonlyMap<string, Value>): void {
    if (values.size) {
      this.all.value = this.all.value.map((parameter) =>
        values.has(parameter.name) ? { ...parameter, value: values.get(parameter.name) } : parameter,
      );
    }
  }

  private async send(): Promise<void> {
    if (this.isSending) {
      return;
    }
    this.isSending = true;
    while (this.unsent.size) {
      const sent = [...this.unsent];
      this.unsent.clear();
      await this.attempt(() => this.write(sent));
    }
    this.isSending = false;
  }

  private async write(values: readonly (readonly [name: string, value: Value])[]): Promise<void> {
    const types = new Map(this.all.peek().map(({ name, type }) => [name, type]));
    const parameters = values.map(([name, value]) => ({ name, value: toMessage(types.get(name) ?? 0, value) }));
    const { results } = await this.call<SetParameters>("set_parameters", { parameters });
    const refused = results.flatMap(({ successful, reason }, i) =>
      successful ? [] : [{ name: values[i]?.[0], reason }],
    );
    if (refused.length) {
      await this.read(); // as they are
      throw new Error(refused.map(({ name, reason }) => reason || `${name} was refused`).join("; "));
    }
  }
}
