// Services, and the calls that wait for a response.
import type { AdvertisedService } from "../generated/protocol";
import { attempt, makeReader, makeWriter } from "./codecs";
import { serviceRequestFrame } from "./frames";
import type { Output } from "./output";

export class Calls {
  private readonly services = new Map<number, AdvertisedService>();
  private readonly waiting = new Map<number, AdvertisedService>();

  constructor(private readonly out: Output) {}

  /** Fail all calls after the connection was lost. */
  reset(): void {
    this.services.clear();
    for (const id of [...this.waiting.keys()]) {
      this.fail(id, "the connection was lost");
    }
  }

  offer(services: readonly AdvertisedService[]): void {
    for (const service of services) {
      this.services.set(service.id, service);
    }
    this.publish();
  }

  withdraw(ids: readonly number[]): void {
    for (const id of ids) {
      this.services.delete(id);
    }
    this.publish();
  }

  call(id: number, name: string, request: unknown): void {
    const service = [...this.services.values()].find((each) => each.name === name);
    if (!service) {
      this.fail(id, `there is no service ${name}`);
      return;
    }
    const done = attempt(() => {
      const write = makeWriter(service.request?.schema ?? service.requestSchema ?? "");
      this.out.toServer(serviceRequestFrame(service.id, id, write(request)));
    });
    if (done instanceof Error) {
      this.fail(id, done.message);
    } else {
      this.waiting.set(id, service);
    }
  }

  /** The definition of a service's requests. */
  requestOf(name: string): string | undefined {
    const service = [...this.services.values()].find((each) => each.name === name);
    return service && (service.request?.schema ?? service.requestSchema ?? "");
  }

  answer(id: number, payload: Uint8Array): void {
    const service = this.waiting.get(id);
    if (!service) {
      return;
    }
    const read = () => makeReader(service.response?.schema ?? service.responseSchema ?? "")(payload);
    const message = attempt(read);
    if (message instanceof Error) {
      this.fail(id, message.message);
    } else {
      this.waiting.delete(id);
      this.out.toPage({ kind: "response", id, message });
    }
  }

  fail(id: number, error: string): void {
    this.waiting.delete(id);
    this.out.toPage({ kind: "response", id, error });
  }

  private publish(): void {
    const services = [...this.services.values()].map(({ name, type }) => ({ name, type }));
    services.sort((a, b) => a.name.localeCompare(b.name));
    this.out.toPage({ kind: "services", services });
  }
}
