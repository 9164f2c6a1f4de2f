import { describe, expect, it } from "vitest";
import type { ConnectionGraph } from "../../connection/boundary";
import { around, diagramOf, type DiagramOptions } from "./diagram";

const GRAPH: ConnectionGraph = {
  publishers: new Map([
    ["/chatter", ["/talker"]],
    ["/alone", ["/talker"]],
    ["/rosout", ["/talker", "/listener"]],
    ["/tf", ["/talker"]],
    ["/_inner", ["/talker"]],
  ]),
  subscribers: new Map([
    ["/chatter", ["/listener", "/_daemon"]],
    ["/tf", ["/listener"]],
    ["/_inner", ["/listener"]],
    ["/rosout", ["/rqt_gui_py_node_12"]],
  ]),
  services: new Map([["/add", ["/server"]]]),
};
const WISHES: DiagramOptions = { kind: "active", filter: "", debug: false, tf: false, hidden: false };

const names = (options: Partial<DiagramOptions>) =>
  diagramOf(GRAPH, { ...WISHES, ...options }).boxes.map(({ is, name }) => `${is} ${name}`);
const NODES = ["node /listener", "node /server", "node /talker"];

describe("the diagram", () => {
  it("shows nodes and the topics that connect them", () => {
    expect(names({})).toEqual([...NODES, "topic /chatter"]);
    expect(diagramOf(GRAPH, WISHES).arrows).toEqual([
      { from: "n/talker", to: "t/chatter", topics: ["/chatter"] },
      { from: "t/chatter", to: "n/listener", topics: ["/chatter"] },
    ]);
  });

  it("shows all topics, tools, transforms and hidden names on demand", () => {
    expect(names({ kind: "all" })).toEqual([...NODES, "topic /alone", "topic /chatter"]);
    expect(names({ tf: true })).toContain("topic /tf");
    expect(names({ hidden: true })).toEqual(expect.arrayContaining(["node /_daemon", "topic /_inner"]));
    expect(names({ debug: true })).toEqual(expect.arrayContaining(["node /rqt_gui_py_node_12", "topic /rosout"]));
  });

  it("shows nodes alone, with one arrow for all that one says to another", () => {
    const { boxes, arrows } = diagramOf(GRAPH, { ...WISHES, kind: "nodes", tf: true });
    expect(boxes.map(({ name }) => name)).toEqual(["/listener", "/server", "/talker"]);
    expect(arrows).toEqual([{ from: "n/talker", to: "n/listener", topics: ["/chatter", "/tf"] }]);
  });

  it("narrows down to a name and its neighbours", () => {
    expect(names({ filter: "listen" })).toEqual(["node /listener", "topic /chatter"]);
  });

  it("knows who is next to whom", () => {
    const { boxes, arrows } = around(diagramOf(GRAPH, WISHES), "t/chatter");
    expect([...boxes].sort()).toEqual(["n/listener", "n/talker", "t/chatter"]);
    expect([...arrows]).toEqual([0, 1]);
  });
});
