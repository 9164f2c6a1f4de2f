import { expect, it } from "vitest";
import type { Session } from "../contract";
import { NodeParameters } from "./node_parameters";

const settled = () => new Promise((done) => setTimeout(done));

it("says why a value was refused, and shows the one that holds", async () => {
  const answers: Record<string, unknown> = {
    "/node/list_parameters": { result: { names: ["speed"] } },
    "/node/describe_parameters": { descriptors: [{ floating_point_range: [], integer_range: [] }] },
    "/node/get_parameters": { values: [{ type: 3, double_value: 1 }] },
    "/node/set_parameters": { results: [{ successful: false, reason: "speed must be at most 2, got 9" }] },
  };
  const session = { call: async (service: string) => answers[service], subscribe: () => () => undefined };
  const parameters = new NodeParameters(session as unknown as Session, "/node");
  parameters.follow();
  await settled();
  parameters.set("speed", 9);
  expect(parameters.all.value[0]?.value).toBe(9);
  await settled();
  expect(parameters.all.value[0]?.value).toBe(1);
  expect(parameters.error.value).toBe("speed must be at most 2, got 9");
});
