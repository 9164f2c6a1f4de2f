// The fields of a message as a tree; numbers can be dragged into plots.
import { useState } from "preact/hooks";
import type { Studio } from "../../app/studio";
import { isTypedArray } from "../../ros/fields";
import { Icon } from "../../ui/icons";
import { PLOT_DRAG } from "../plot/drag";

const ARRAY_PREVIEW = 4;
const ARRAY_PAGE = 50;
const OPEN_DEPTH = 2;
const LONGEST_TEXT = 400;

interface FieldsProps {
  studio: Studio;
  value: unknown;
  /** Of the value: topic and fields. */
  path: string;
  depth: number;
  /** Down to which depth it is unfolded at first. */
  unfolded?: number;
}

/** The fields of a value, one a line. */
export function Fields({ studio, value, path, depth, unfolded = OPEN_DEPTH }: FieldsProps) {
  return (
    <>
      {entries(value).map(([name, field]) => (
        <Field key={name} {...{ studio, name, depth, unfolded }} value={field} path={`${path}/${name}`} />
      ))}
    </>
  );
}

function Field({ studio, name, value, path, depth, unfolded = OPEN_DEPTH }: FieldsProps & { name: string }) {
  const nested = typeof value === "object" && value !== null;
  const [open, setOpen] = useState(nested && depth < unfolded && !isArray(value));
  const [shown, setShown] = useState(ARRAY_PAGE);
  const indent = { paddingLeft: `${8 + depth * 14}px` };
  if (!nested) {
    const canBePlotted = ["number", "bigint", "boolean"].includes(typeof value);
    return (
      <div
        class="tree-row leaf"
        style={indent}
        data-path={path}
        draggable={canBePlotted}
        onDragStart={(event) => event.dataTransfer?.setData(PLOT_DRAG, path)}
        onDblClick={() => canBePlotted && studio.addToPlot.value?.(path)}
        title={canBePlotted ? `${path}\nDrag it into a plot, or double click` : path}
      >
        <span class="turn" />
        <span class="key">{name}</span>
        <span class={`value ${typeof value}`}>{leaf(value)}</span>
      </div>
    );
  }
  const length = isArray(value) ? value.length : 0;
  return (
    <>
      <button class="bare tree-row" style={indent} aria-expanded={open} onClick={() => setOpen(!open)}>
        <span class="turn">
          <Icon name="chevron" size={11} />
        </span>
        <span class="key">{name}</span>
        <span class="summary ellipsis">{open ? "" : summary(value)}</span>
      </button>
      {open && (
        <Fields {...{ studio, path, unfolded }} value={isArray(value) ? head(value, shown) : value} depth={depth + 1} />
      )}
      {open && length > shown && (
        <button class="bare tree-row more" style={indent} onClick={() => setShown(shown + ARRAY_PAGE)}>
          {length - shown} more
        </button>
      )}
    </>
  );
}

type AnyArray = ArrayLike<unknown>;

function isArray(value: unknown): value is AnyArray {
  return Array.isArray(value) || isTypedArray(value);
}

function entries(value: unknown): [string, unknown][] {
  if (isArray(value)) {
    return Array.from(value, (each, i) => [String(i), each]);
  }
  return typeof value === "object" && value !== null ? Object.entries(value) : [];
}

function head(value: AnyArray, count: number): unknown[] {
  return Array.from({ length: Math.min(count, value.length) }, (_, i) => value[i]);
}

function leaf(value: unknown): string {
  switch (typeof value) {
    case "number":
      return Number.isInteger(value) ? String(value) : String(Number(value.toPrecision(7)));
    case "string":
      return value.length > LONGEST_TEXT ? `${value.slice(0, LONGEST_TEXT)}…` : value || "(empty)";
  }
  return String(value);
}

function summary(value: unknown): string {
  if (isArray(value)) {
    const numbers = value.length > 0 && typeof value[0] !== "object";
    const preview = numbers
      ? `: ${head(value, ARRAY_PREVIEW).map(leaf).join(", ")}${value.length > ARRAY_PREVIEW ? ", …" : ""}`
      : "";
    return `${value.length} items${preview}`;
  }
  const fields = entries(value);
  const plain = fields.every(([, field]) => typeof field !== "object");
  return plain ? fields.map(([name, field]) => `${name} ${leaf(field)}`).join("  ") : `${fields.length} fields`;
}
