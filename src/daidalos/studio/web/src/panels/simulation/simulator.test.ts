import { describe, expect, it } from "vitest";
import type { Session } from "../../connection/session";
import { errorOf, Simulator } from "./simulator";

function simulator(answer: unknown) {
  const asked: [string, unknown][] = [];
  const session = {
    call: (service: string, request: unknown) => {
      asked.push([service, request]);
      return Promise.resolve(answer);
    },
  } as unknown as Session;
  return { asked, made: new Simulator(session, "/gazebo") };
}

describe("the simulator", () => {
  it("is asked by its own services", async () => {
    const { asked, made } = simulator({ result: { result: 1, error_message: "" } });
    await made.step(10);
    await made.play(false);
    await made.reset();
    expect(asked).toEqual([
      ["/gazebo/step_simulation", { steps: 10n }],
      ["/gazebo/set_simulation_state", { state: { state: 2 } }],
      ["/gazebo/reset_simulation", { scope: 3 }], // what was spawned stays
    ]);
    expect(made.isPlaying.value).toBe(false);
  });

  it("puts shapes onto the ground", async () => {
    const { asked, made } = simulator({ success: true, status_message: "", name: "box_1" });
    const color = { r: 1, g: 0, b: 0, a: 1 };
    expect(await made.insert("box", { x: 1, y: 2, z: 0 }, 0.5, 1, color)).toBe("box_1");
    expect(asked[0]?.[1]).toMatchObject({ shape: "box", pose: { position: { x: 1, y: 2, z: 0.25 } }, mass: 1 });
  });

  it("says why it refuses", async () => {
    const { made } = simulator({ result: { result: 2, error_message: "no crate" } });
    await expect(made.remove("crate")).rejects.toThrow("no crate");
    expect(errorOf({ success: false, status_message: "too small" })).toBe("too small");
    expect(errorOf({ success: true })).toBeUndefined();
  });
});
