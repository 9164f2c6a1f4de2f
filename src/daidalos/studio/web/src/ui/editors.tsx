// Editors of single values: switch, number, colour, choice.
import { useEffect, useRef } from "preact/hooks";

export function Toggle({ on, onChange, label }: { on: boolean; onChange(on: boolean): void; label: string }) {
  return (
    <input
      type="checkbox"
      class="toggle"
      role="switch"
      aria-label={label}
      checked={on}
      onChange={(event) => onChange(event.currentTarget.checked)}
    />
  );
}

interface NumberProps {
  value: number;
  min: number;
  max: number;
  step: number;
  unit?: string | undefined;
  label: string;
  onChange(value: number): void;
}

export function NumberField({ value, min, max, step, unit, label, onChange }: NumberProps) {
  const field = useRef<HTMLInputElement>(null);
  useEffect(() => {
    // What is being typed is not overwritten.
    if (field.current && document.activeElement !== field.current) {
      field.current.value = String(value);
    }
  }, [value]);
  const commit = (text: string) => {
    const typed = Number(text);
    if (text.trim() !== "" && Number.isFinite(typed)) {
      onChange(Math.min(max, Math.max(min, typed)));
    }
  };
  return (
    <span class="field with-unit">
      <input
        ref={field}
        type="number"
        aria-label={label}
        defaultValue={String(value)}
        {...{ min, max, step }}
        onInput={(event) => commit(event.currentTarget.value)}
        onBlur={(event) => (event.currentTarget.value = String(value))}
      />
      {unit && <span class="unit">{unit}</span>}
    </span>
  );
}

export function ColorField({ value, onChange, label }: { value: string; onChange(hex: string): void; label: string }) {
  return (
    <label class="field color">
      <input type="color" aria-label={label} value={value} onInput={(event) => onChange(event.currentTarget.value)} />
      <span class="mono">{value}</span>
    </label>
  );
}

interface ChoiceProps {
  value: string;
  options: readonly (readonly [value: string, label: string])[];
  onChange(value: string): void;
  label: string;
}

export function Choice({ value, options, onChange, label }: ChoiceProps) {
  const known = options.some(([each]) => each === value);
  return (
    <select class="field" aria-label={label} value={value} onChange={(event) => onChange(event.currentTarget.value)}>
      {!known && <option value={value}>{value || "none"}</option>}
      {options.map(([each, text]) => (
        <option key={each} value={each}>
          {text}
        </option>
      ))}
    </select>
  );
}
