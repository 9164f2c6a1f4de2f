// Turtlesim: the window of a turtlesim_node, where turtles drive and draw.
import { useSignal, type Signal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import type { Studio } from "../app/studio";
import { Choice } from "../ui/editors";
import { Empty } from "../ui/empty";
import { Icon } from "../ui/icons";
import { type BuiltInPanel, type PanelProps, withPreact } from "./panel";
import "../styles/turtlesim.css";

import type { GetTurtleDrawing, TurtleWindow } from "../generated/daidalos_msgs";
import { DrawingFollower } from "./turtlesim/follower";
import { Tank } from "./turtlesim/tank";

const TYPE = "daidalos_msgs/msg/TurtleWindow";
const KEEP = 64;
const REFRESH_S = 0.1;
const SETTLED_MS = 150;

function TurtlesimPanel({ studio, visible, params, remember }: PanelProps) {
  const { session } = studio;
  const windows = session.topics.value.filter(({ type }) => type === TYPE).map(({ name }) => name);
  const chosen = useSignal(typeof params.window === "string" ? params.window : "");
  const last = useRef("");
  // What a simulator drew stays to be looked at when it has ended.
  const topic = windows.includes(chosen.value) ? chosen.value : (windows[0] ?? last.current);
  last.current = topic;
  const shown = useSignal<TurtleWindow | undefined>(undefined);
  return (
    <div class="column turtlesim">
      {topic ? (
        <>
          <Bar studio={studio} topic={topic} />
          <Water
            key={topic}
            studio={studio}
            topic={topic}
            isVisible={visible.value}
            isLost={!windows.includes(topic)}
            shown={shown}
          />
          <div class="turtlesim-foot">
            <Turtles shown={shown} />
            {windows.length > 1 && (
              <Choice
                label="Simulator"
                value={topic}
                options={windows.map((name) => [name, nodeOf(name)])}
                onChange={(name) => {
                  chosen.value = name;
                  remember({ window: name });
                }}
              />
            )}
          </div>
        </>
      ) : (
        <Empty icon="turtle" title="No turtlesim is running">
          <code>ros2 run turtlesim turtlesim_node</code>
        </Empty>
      )}
    </div>
  );
}

function Bar({ studio: { session }, topic }: { studio: Studio; topic: string }) {
  const errorText = useSignal("");
  const call = (service: string, request: object) => {
    errorText.value = "";
    session.call(`${namespaceOf(topic)}${service}`, request).catch((error: Error) => (errorText.value = error.message));
  };
  const spawn = () => {
    const place = () => 1.5 + 8 * Math.random();
    call("spawn", { x: place(), y: place(), theta: 2 * Math.PI * Math.random() - Math.PI, name: "" });
  };
  return (
    <div class="bar">
      <strong class="ellipsis">{nodeOf(topic)}</strong>
      <span class="faint ellipsis">{errorText.value}</span>
      <span class="stretch" />
      <button class="button" title="Add a turtle somewhere (spawn)" data-test="spawn" onClick={spawn}>
        <Icon name="add" /> Spawn
      </button>
      <button class="button" title="Wipe the lines (clear)" data-test="clear" onClick={() => call("clear", {})}>
        <Icon name="trash" /> Clear
      </button>
      <button class="button" title="Begin again (reset)" data-test="reset" onClick={() => call("reset", {})}>
        <Icon name="reset" /> Reset
      </button>
    </div>
  );
}

interface WaterProps {
  studio: Studio;
  topic: string;
  isVisible: boolean;
  isLost: boolean;
  shown: Signal<TurtleWindow | undefined>;
}

function Water({ studio, topic, isVisible, isLost, shown }: WaterProps) {
  const { session } = studio;
  const around = useRef<HTMLDivElement>(null);
  const square = useRef<HTMLDivElement>(null);
  const drawing = useRef<HTMLCanvasElement>(null);
  const turtles = useRef<HTMLCanvasElement>(null);
  const tank = useRef<Tank>(undefined);
  useEffect(() => {
    if (!isVisible) {
      return undefined;
    }
    const [box, frame] = [around.current as HTMLDivElement, square.current as HTMLDivElement];
    const made = new Tank(drawing.current as HTMLCanvasElement, turtles.current as HTMLCanvasElement);
    tank.current = made;
    const service = topic.replace(/_window$/, "_drawing");
    const follower = new DrawingFollower(made.paper, () => session.call<GetTurtleDrawing>(service, {}));
    let settling = 0;
    const fit = () => {
      const size = Math.max(0, Math.min(box.clientWidth, box.clientHeight));
      frame.style.width = frame.style.height = `${size}px`;
      if (made.resize(size)) {
        clearTimeout(settling);
        settling = window.setTimeout(() => void follower.catchUp(), SETTLED_MS);
      }
    };
    const observer = new ResizeObserver(fit);
    observer.observe(box);
    fit();
    let newest: TurtleWindow | undefined;
    let toldAt = 0;
    const stops = [
      session.subscribe<TurtleWindow>(topic, KEEP, (message) => {
        newest = message;
        made.show(message);
        follower.receive(message);
      }),
      studio.onFrame((page) => {
        made.frame(page);
        if (newest && page - toldAt > REFRESH_S) {
          toldAt = page;
          shown.value = newest;
          frame.style.backgroundColor = `rgb(${newest.r} ${newest.g} ${newest.b})`;
        }
      }),
    ];
    return () => {
      observer.disconnect();
      clearTimeout(settling);
      stops.forEach((stop) => stop());
    };
  }, [isVisible]);
  const hover = (event: PointerEvent) => {
    const box = (square.current as HTMLDivElement).getBoundingClientRect();
    const found = tank.current?.turtleAt(
      (event.clientX - box.left) / box.width,
      (event.clientY - box.top) / box.height,
    );
    if (tank.current && tank.current.hovered !== (found?.name ?? "")) {
      tank.current.hovered = found?.name ?? "";
      tank.current.redraw();
    }
  };
  return (
    <div class="turtlesim-around" ref={around}>
      <div class={`turtlesim-square ${isLost ? "lost" : ""}`} ref={square} data-test="turtlesim" onPointerMove={hover}>
        <canvas ref={drawing} />
        <canvas ref={turtles} />
        {isLost && <div class="turtlesim-note">This turtlesim is no longer running</div>}
      </div>
    </div>
  );
}

/** Where the turtles are, in figures. */
function Turtles({ shown }: { shown: Signal<TurtleWindow | undefined> }) {
  return (
    <span class="turtles grow">
      {shown.value?.turtles.map(({ name, x, y, theta }) => (
        <span key={name} class="turtle figures" data-turtle={name}>
          <b>{name}</b> x {x.toFixed(2)} · y {y.toFixed(2)} · θ {theta.toFixed(2)}
        </span>
      ))}
    </span>
  );
}

/** The node that has a window, by the window's topic. */
function nodeOf(topic: string): string {
  return topic.replace(/\/_window$/, "");
}

function namespaceOf(topic: string): string {
  return nodeOf(topic).replace(/[^/]*$/, "");
}

export default {
  id: "turtlesim",
  title: "TurtleSim",
  icon: "turtle",
  mount: withPreact(TurtlesimPanel),
} satisfies BuiltInPanel;
