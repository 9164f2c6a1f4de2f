// 3D: the view of the robot's world, with RViz's tools and views.
import { useSignal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import type { Studio } from "../app/studio";
import { attachWorld } from "../app/test_hooks";
import { followed, World } from "../scene/world";
import { TOOLS } from "../tools/registry";
import { Icon } from "../ui/icons";
import { type BuiltInPanel, type PanelProps, withPreact } from "./panel";
import "../styles/view_3d.css";

const MOUSE_HINT = {
  orbit: "Left: turn · Middle: move · Right or wheel: zoom",
  top: "Left: move · Shift + left: turn · Right or wheel: zoom",
} as const;

const INVITATION = "Send the robot somewhere: press g, then click on the map and drag to where it shall look";

function ScenePanel({ studio, visible }: PanelProps) {
  const container = useRef<HTMLDivElement>(null);
  const world = useSignal<World | undefined>(undefined);
  const failure = useSignal("");
  useEffect(() => {
    try {
      const made = new World(container.current as HTMLDivElement, studio, () => visible.value);
      world.value = made;
      const detach = attachWorld(made);
      return () => {
        detach();
        made.dispose();
      };
    } catch (error) {
      failure.value = error instanceof Error ? error.message : String(error);
      return undefined;
    }
  }, []);
  // A planner's map tells that somebody drives where the goal tool says.
  const canNavigate = studio.session.topics.value.some(({ name }) => /\/(plan|global_costmap\/costmap)$/.test(name));
  return (
    <div class="scene">
      <div class="scene-canvas" ref={container} />
      {world.value && <Toolbar world={world.value} canNavigate={canNavigate} />}
      {world.value && <ViewButtons world={world.value} />}
      {world.value && <Hint world={world.value} canNavigate={canNavigate} />}
      {failure.value && (
        <div class="empty over">
          <Icon name="cube" size={28} />
          <strong>This browser can not draw in 3-D</strong>
          <span>{failure.value}. WebGL 2 must be switched on in its settings.</span>
        </div>
      )}
      <Note studio={studio} />
    </div>
  );
}

function Toolbar({ world, canNavigate }: { world: World; canNavigate: boolean }) {
  const { toolbox } = world;
  const invites = canNavigate && !toolbox.used.value.has("goal");
  return (
    <div class="overlay-bar tools" role="toolbar" aria-label="Tools">
      {TOOLS.map((tool) => (
        <button
          key={tool.id}
          class={`tool ${toolbox.active.value === tool ? "active" : ""} ${invites && tool.id === "goal" ? "inviting" : ""}`}
          title={`${tool.title} (${tool.key})`}
          aria-pressed={toolbox.active.value === tool}
          data-tool={tool.id}
          onClick={() => toolbox.take(tool)}
        >
          <Icon name={tool.icon} />
          <span class="tool-title">{tool.title}</span>
        </button>
      ))}
    </div>
  );
}

function ViewButtons({ world }: { world: World }) {
  const follow = () => world.follow(followed.value ? "" : (world.robotFrame() ?? ""));
  const top = world.viewKind.value === "top";
  return (
    <div class="overlay-bar views" role="toolbar" aria-label="View">
      <button
        class={`tool ${top ? "active" : ""}`}
        title="Top-down view (t)"
        aria-pressed={top}
        data-test="top-down"
        onClick={() => world.switchView(top ? "orbit" : "top")}
      >
        <Icon name="top" />
      </button>
      <button
        class={`tool ${followed.value ? "active" : ""}`}
        title="Follow the robot (l)"
        aria-pressed={followed.value !== ""}
        onClick={follow}
      >
        <Icon name="follow" />
      </button>
      <button class="tool" title="Home view (z)" onClick={() => world.home()}>
        <Icon name="home" />
      </button>
    </div>
  );
}

function Hint({ world, canNavigate }: { world: World; canNavigate: boolean }) {
  const { toolbox } = world;
  const tool = toolbox.active.value;
  const invitation = canNavigate && !toolbox.used.value.has("goal") ? INVITATION : "";
  return (
    <div class={`hint ${tool.create ? "busy" : ""}`} data-test="hint">
      {toolbox.saying.value || tool.hint || invitation || MOUSE_HINT[world.viewKind.value]}
    </div>
  );
}

/** What to say while there is nothing to see. */
function Note({ studio }: { studio: Studio }) {
  const { link, topics } = studio.session;
  if (link.value === "connected") {
    return topics.value.length === 0 ? (
      <div class="scene-note" role="status">
        Nothing is published yet. What robots and simulators publish appears here by itself.
      </div>
    ) : null;
  }
  return link.value === "connecting" ? (
    <div class="scene-note" role="status">
      <span class="spinner" />
      Connecting…
    </div>
  ) : null;
}

export default {
  id: "scene",
  title: "3D",
  icon: "cube",
  beside: ["displays", 290],
  mount: withPreact(ScenePanel),
} satisfies BuiltInPanel;
