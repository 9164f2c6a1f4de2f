// Entities: what is in the simulated world, as a tree of models with their links, joints and sensors.
import { useSignal, type Signal } from "@preact/signals";
import { useRef } from "preact/hooks";
import { Empty } from "../ui/empty";
import { Icon, type IconName } from "../ui/icons";
import { SearchField } from "../ui/search";
import { type BuiltInPanel, type PanelProps, withPreact } from "./panel";
import "../styles/entities.css";

import { filterTree, type Entity, type EntityKind, splitEntity } from "./simulation/entity_tree";
import { openRoom, type Room } from "./simulation/room";

const ICONS: Readonly<Record<EntityKind, IconName>> = {
  model: "robot",
  static: "cube",
  link: "link",
  joint: "turn",
  sensor: "scan",
  plugin: "panel",
};
const WORDS: Readonly<Record<EntityKind, string>> = {
  model: "model",
  static: "static model",
  link: "link",
  joint: "joint",
  sensor: "sensor",
  plugin: "plugin",
};

interface Row {
  entity: Entity;
  level: number;
  isOpen: boolean;
}

function EntitiesPanel({ studio }: PanelProps) {
  const room = openRoom.value;
  if (!room) {
    return (
      <Empty icon="cube" title="No simulation is shown">
        <button class="button" onClick={() => studio.openPanel("simulation")}>
          Open the Simulation panel
        </button>
      </Empty>
    );
  }
  return <Tree room={room} />;
}

function Tree({ room: { stage, editor } }: { room: Room }) {
  const filter = useSignal("");
  const open = useSignal<ReadonlySet<string>>(new Set());
  /** The row that has the keyboard: a part, or the selected model. */
  const current = useSignal("");
  const list = useRef<HTMLDivElement>(null);
  const entities = filterTree(stage.entities.value, filter.value.trim());
  const rows = rowsOf(entities, open.value, filter.value.trim() !== "");
  const selected = current.value.startsWith(`${stage.selected.value}::`) ? current.value : stage.selected.value;
  const choose = (id: string) => {
    current.value = id;
    stage.select(splitEntity(id).model);
  };
  const step = (row: Row | undefined) => {
    if (row) {
      choose(row.entity.id);
      list.current?.querySelectorAll<HTMLElement>("[role=treeitem]")[rows.indexOf(row)]?.focus();
    }
  };
  const onKey = (event: KeyboardEvent, row: Row) => {
    if (actOnKey(event, row, rows, step, open)) {
      event.preventDefault();
      event.stopPropagation();
    } else if (event.key === "Delete" && row.entity.id === stage.selected.value) {
      void editor.remove();
    }
  };
  return (
    <div class="column">
      <div class="bar">
        <SearchField value={filter.value} placeholder="Filter entities" onChange={(text) => (filter.value = text)} />
        <span class="faint figures" data-test="entity-count">
          {stage.entities.value.length}
        </span>
      </div>
      <div class="scroll entities" role="tree" aria-label="Entities of the world" ref={list}>
        {rows.map((row, i) => (
          <EntityRow
            key={row.entity.id}
            row={row}
            isSelected={row.entity.id === selected}
            isInTabOrder={rows.some(({ entity }) => entity.id === selected) ? row.entity.id === selected : i === 0}
            onChoose={() => choose(row.entity.id)}
            onToggle={() => toggle(open, row.entity.id)}
            onFocus={() => stage.focusOn(row.entity.id)}
            onKey={(event) => onKey(event, row)}
          />
        ))}
        {rows.length === 0 && <p class="faint entities-none">{filter.value ? "Nothing has this name." : "Empty."}</p>}
      </div>
    </div>
  );
}

interface RowProps {
  row: Row;
  isSelected: boolean;
  isInTabOrder: boolean;
  onChoose(): void;
  onToggle(): void;
  /** Centre the view on it. */
  onFocus(): void;
  onKey(event: KeyboardEvent): void;
}

function EntityRow({ row: { entity, level, isOpen }, isSelected, isInTabOrder, ...on }: RowProps) {
  const { id, name, kind, type, parts } = entity;
  return (
    <div
      class={`entity ${isSelected ? "selected" : ""}`}
      role="treeitem"
      aria-level={level + 1}
      aria-selected={isSelected}
      aria-expanded={parts.length ? isOpen : undefined}
      tabIndex={isInTabOrder ? 0 : -1}
      title={`${WORDS[kind]} ${id}${type ? `, ${type}` : ""}`}
      style={{ paddingLeft: `${6 + 16 * level}px` }}
      data-entity={id}
      onClick={on.onChoose}
      onDblClick={on.onFocus}
      onKeyDown={on.onKey}
    >
      <span
        class={`turn ${parts.length ? "" : "hidden"} ${isOpen ? "open" : ""}`}
        aria-hidden="true"
        data-test="unfold"
        onClick={(event) => {
          event.stopPropagation();
          on.onToggle();
        }}
      >
        <Icon name="chevron" size={12} />
      </span>
      <span class={`entity-icon ${kind}`}>
        <Icon name={ICONS[kind]} size={14} />
      </span>
      <span class="ellipsis">{name}</span>
      {(type || kind === "static") && <span class="faint entity-type">{type || "static"}</span>}
    </div>
  );
}

/** The rows of a tree that are unfolded; of a filtered tree all are. */
function rowsOf(entities: readonly Entity[], open: ReadonlySet<string>, all: boolean, level = 0): Row[] {
  return entities.flatMap((entity) => {
    const isOpen = all || open.has(entity.id);
    return [{ entity, level, isOpen }, ...(isOpen ? rowsOf(entity.parts, open, all, level + 1) : [])];
  });
}

function toggle(open: Signal<ReadonlySet<string>>, id: string): void {
  const next = new Set(open.value);
  if (!next.delete(id)) {
    next.add(id);
  }
  open.value = next;
}

/** The keys of a tree by the ARIA pattern; returns whether the key has a meaning. */
function actOnKey(
  { key }: KeyboardEvent,
  row: Row,
  rows: readonly Row[],
  step: (row: Row | undefined) => void,
  open: Signal<ReadonlySet<string>>,
): boolean {
  const place = rows.indexOf(row);
  const { entity, isOpen, level } = row;
  switch (key) {
    case "ArrowDown":
      step(rows[place + 1]);
      return true;
    case "ArrowUp":
      step(rows[place - 1]);
      return true;
    case "Home":
      step(rows[0]);
      return true;
    case "End":
      step(rows.at(-1));
      return true;
    case "ArrowRight":
      if (entity.parts.length && !isOpen) {
        toggle(open, entity.id);
      } else if (isOpen) {
        step(rows[place + 1]);
      }
      return true;
    case "ArrowLeft":
      if (isOpen && open.value.has(entity.id)) {
        toggle(open, entity.id);
      } else {
        step(rows.slice(0, place).findLast((each) => each.level < level));
      }
      return true;
    case "Enter":
    case " ":
      step(row);
      return true;
  }
  return false;
}

export default {
  id: "entities",
  title: "Entities",
  icon: "tree",
  mount: withPreact(EntitiesPanel),
} satisfies BuiltInPanel;
