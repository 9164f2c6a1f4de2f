import { beforeEach, expect, it } from "vitest";
import type { Session } from "../../contract";
import { Joints } from "./joints";

let asked: [string, unknown][];
let hear: (event: unknown) => void;
let joints: Joints;

const settled = () => new Promise((done) => setTimeout(done));
const event = (change: object) => ({
  node: "/gui",
  new_parameters: [],
  changed_parameters: [],
  deleted_parameters: [],
  ...change,
});

beforeEach(async () => {
  asked = [];
  const answers: Record<string, unknown> = {
    "/gui/list_parameters": { result: { names: ["joints.pan", "joints.tilt"] } },
    "/gui/describe_parameters": {
      descriptors: [
        { description: "position of pan [rad]", floating_point_range: [{ from_value: -1, to_value: 2 }] },
        { floating_point_range: [] },
      ],
    },
    "/gui/get_parameters": {
      values: [
        { type: 3, double_value: 0.5 },
        { type: 3, double_value: 0 },
      ],
    },
  };
  const session = {
    call: (service: string, request: unknown) => {
      asked.push([service, request]);
      return Promise.resolve(answers[service] ?? { results: [] });
    },
    subscribe: (_topic: string, _keep: number, received: typeof hear) => {
      hear = received;
      return () => undefined;
    },
  };
  joints = new Joints(session as unknown as Session, "/gui");
  joints.follow();
  await settled();
});

it("reads the joints and their limits", () => {
  expect(joints.joints.value).toEqual([
    { name: "pan", lower: -1, upper: 2, value: 0.5, unit: "rad" },
    { name: "tilt", lower: -Math.PI, upper: Math.PI, value: 0, unit: "" },
  ]);
});

it("sends the newest position only", async () => {
  asked = [];
  for (const value of [0.1, 0.2, 0.3]) {
    joints.set("pan", value);
  }
  await settled();
  const sent = asked.map(([, request]) => (request as { parameters: { value: object }[] }).parameters[0]?.value);
  expect(sent).toEqual([
    { type: 3, double_value: 0.1 },
    { type: 3, double_value: 0.3 },
  ]);
  expect(joints.joints.value[0]?.value).toBe(0.3);
});

it("follows the node, and no other", async () => {
  hear(event({ changed_parameters: [{ name: "joints.tilt", value: { type: 3, double_value: 1 } }] }));
  hear(event({ node: "/other", changed_parameters: [{ name: "joints.tilt", value: { type: 3, double_value: 2 } }] }));
  expect(joints.joints.value[1]?.value).toBe(1);
  asked = [];
  hear(event({ new_parameters: [{ name: "joints.roll", value: { type: 3, double_value: 0 } }] }));
  await settled();
  expect(asked[0]?.[0]).toBe("/gui/list_parameters");
});
