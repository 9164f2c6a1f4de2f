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
  orbit: "Left: rotate · Middle: move · Right or wheel: zoom",
  top: "Left: move · Shift + left: rotate · Right or wheel: zoom",
} as const;

const GOAL_HINT = "Set a goal: press g, click on the map and drag in the direction of the heading";

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
  // A planner's topics show that a navigator accepts the goals of the goal tool.
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
          <strong>This browser does not support WebGL 2</strong>
          <span>{failure.value}. Enable WebGL 2 in its settings.</span>
        </div>
      )}
      <Note studio={studio} />
    </div>
  );
}

function Toolbar({ world, canNavigate }: { world: World; canNavigate: boolean }) {
  const { toolbox } = world;
  const showsGoalHint = canNavigate && !toolbox.used.value.has("goal");
  return (
    <div class="overlay-bar tools" role="toolbar" aria-label="Tools">
      {TOOLS.map((tool) => (
        <button
          key={tool.id}
          class={`tool ${toolbox.active.value === tool ? "active" : ""} ${showsGoalHint && tool.id === "goal" ? "inviting" : ""}`}
          title={`${tool.title} (${tool.key})`}
          aria-pressed={toolbox.active.value === tool}
          data-tool={tool.id}
          onClick={() => toolbox.select(tool)}
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
  const goalHint = canNavigate && !toolbox.used.value.has("goal") ? GOAL_HINT : "";
  return (
    <div class={`hint ${tool.create ? "busy" : ""}`} data-test="hint">
      {toolbox.message.value || tool.hint || goalHint || MOUSE_HINT[world.viewKind.value]}
    </div>
  );
}

/** A note while there is nothing to draw. */
function Note({ studio }: { studio: Studio }) {
  const { link, topics } = studio.session;
  if (link.value === "connected") {
    return topics.value.length === 0 ? (
      <div class="scene-note" role="status">
        No topics are published yet. Published data appears here automatically.
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
