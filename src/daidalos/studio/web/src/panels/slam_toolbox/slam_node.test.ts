import { describe, expect, it } from "vitest";
import type { Session } from "../../contract";
import { SlamNode, slamNodes, toPlanar, toSpatial } from "./slam_node";

const SERVICES = [
  { name: "/slam_toolbox/pause_new_measurements", type: "slam_toolbox/srv/Pause" },
  { name: "/slam_toolbox/save_map", type: "slam_toolbox/srv/SaveMap" },
  { name: "/left/slam_toolbox/add_submap", type: "slam_toolbox/srv/AddSubmap" },
  { name: "/other/pause_new_measurements", type: "std_srvs/srv/Trigger" },
];

/** A node whose services answer with `response`, and the requests that it gets. */
function nodeWith(response: unknown, name = "/slam_toolbox"): { node: SlamNode; requests: unknown[][] } {
  const requests: unknown[][] = [];
  const session = {
    services: { value: SERVICES },
    call: (...request: unknown[]) => (requests.push(request), Promise.resolve(response)),
    publish: (...request: unknown[]) => requests.push(request),
  } as unknown as Session;
  return { node: new SlamNode(session, name), requests };
}

describe("slam_toolbox's nodes", () => {
  it("are found by their services", () => {
    expect(slamNodes(SERVICES)).toEqual(["/slam_toolbox", "/left/slam_toolbox"]);
    const { node } = nodeWith({});
    expect([node.has("save_map"), node.has("clear_queue")]).toEqual([true, false]);
  });

  it("load a pose graph at the first scan, at a pose, or to localize near one", async () => {
    const { node, requests } = nodeWith({});
    const pose = { x: 1, y: 2, theta: 0.5 };
    await node.deserialize("/tmp/hall", "dock", pose);
    await node.deserialize("/tmp/hall", "pose", pose);
    await node.deserialize("/tmp/hall", "localize", pose);
    expect(requests.map(([, request]) => request)).toEqual([
      { filename: "/tmp/hall", match_type: 1 },
      { filename: "/tmp/hall", match_type: 2, initial_pose: pose },
      { filename: "/tmp/hall", match_type: 3, initial_pose: pose },
    ]);
  });

  it("report that a map was not saved", async () => {
    const { node } = nodeWith({ result: 1 });
    await node.saveMap("hall");
    expect(node.reports.value).toEqual([{ text: "there is no map to be saved yet", level: 40 }]);
    expect(node.isBusy.value).toBe(false);
  });

  it("take a key scan that was moved", () => {
    const { node, requests } = nodeWith({});
    node.move(7, { x: 1, y: 2, theta: Math.PI });
    const [dragged, released] = requests.map(([, , message]) => message as { event_type: number; marker_name: string });
    expect([dragged?.event_type, released?.event_type]).toEqual([1, 5]);
    expect(released?.marker_name).toBe("7");
    expect(requests[0]?.[0]).toBe("/slam_toolbox/feedback");
  });

  it("that merge maps take submaps that were moved", () => {
    const { node, requests } = nodeWith({}, "/left/slam_toolbox");
    node.move(2, { x: 1, y: 2, theta: 0 });
    expect(requests[0]?.[0]).toBe("/left/merge_maps_tool/feedback");
    expect(node.movable.value.get(2)).toEqual({ x: 1, y: 2, theta: 0 });
  });
});

describe("poses in the plane", () => {
  it("become poses in space and back", () => {
    const pose = { x: -1, y: 0.5, theta: -2.5 };
    const back = toPlanar(toSpatial(pose));
    expect([back.x, back.y]).toEqual([-1, 0.5]);
    expect(back.theta).toBeCloseTo(-2.5);
  });
});
