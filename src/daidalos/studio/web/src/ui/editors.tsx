// Editors of single values: switch, number, range, colour, choice, text.
import { useEffect, useRef } from "preact/hooks";

interface ToggleProps {
  on: boolean;
  label: string;
  disabled?: boolean;
  onChange(on: boolean): void;
}

export function Toggle({ on, onChange, label, disabled = false }: ToggleProps) {
  return (
    <input
      type="checkbox"
      class="toggle"
      role="switch"
      aria-label={label}
      disabled={disabled}
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

interface RangeProps {
  value: number;
  /** Infinite where there is no bound. */
  min: number;
  max: number;
  /** 0: any number between them. */
  step?: number;
  unit?: string;
  label: string;
  disabled?: boolean;
  onChange(value: number): void;
}

/** A number, with a slider where it has both bounds. */
export function RangeField({ value, min, max, step = 0, unit, label, disabled = false, onChange }: RangeProps) {
  const limit = (typed: number) => Math.min(max, Math.max(min, typed));
  const share = (at: number) => (max > min ? (100 * (limit(at) - min)) / (max - min) : 0);
  const isBounded = Number.isFinite(max - min);
  // As many as the range needs: three in ranges of one and more.
  const digits = isBounded ? Math.min(12, Math.max(3, 3 - Math.floor(Math.log10(max - min)))) : 0;
  const ends = isBounded ? [share(0), share(value)].sort((a, b) => a - b) : [];
  return (
    <>
      <span class="field with-unit">
        <input
          class="range-value figures"
          type="number"
          aria-label={label}
          disabled={disabled}
          step={step || (isBounded ? 10 ** (1 - digits) : "any")}
          {...(Number.isFinite(min) ? { min } : {})}
          {...(Number.isFinite(max) ? { max } : {})}
          value={step || !isBounded ? String(value) : value.toFixed(digits)}
          onChange={(event) => {
            const typed = Number(event.currentTarget.value);
            if (event.currentTarget.value.trim() && Number.isFinite(typed)) {
              onChange(limit(typed));
            }
          }}
        />
        {unit && <span class="unit">{unit}</span>}
      </span>
      {isBounded && (
        <input
          class="slider"
          type="range"
          aria-label={`${label}, slider`}
          disabled={disabled}
          {...{ min, max, value }}
          step={step || "any"}
          style={`--from: ${ends[0]}%; --to: ${ends[1]}%`}
          onInput={(event) => onChange(limit(Number(event.currentTarget.value)))}
        />
      )}
    </>
  );
}

interface TextProps {
  value: string;
  label: string;
  /** Shown while it is empty. */
  placeholder?: string;
  disabled?: boolean;
  onChange(value: string): void;
}

/** A text; changes are reported when it is entered or loses the focus. */
export function TextField({ value, label, placeholder = "", disabled = false, onChange }: TextProps) {
  return (
    <input
      class="field"
      type="text"
      aria-label={label}
      spellcheck={false}
      placeholder={placeholder}
      disabled={disabled}
      value={value}
      onChange={(event) => onChange(event.currentTarget.value)}
    />
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
  disabled?: boolean;
}

export function Choice({ value, options, onChange, label, disabled = false }: ChoiceProps) {
  const known = options.some(([each]) => each === value);
  return (
    <select
      class="field"
      aria-label={label}
      disabled={disabled}
      value={value}
      onChange={(event) => onChange(event.currentTarget.value)}
    >
      {!known && <option value={value}>{value || "none"}</option>}
      {options.map(([each, text]) => (
        <option key={each} value={each}>
          {text}
        </option>
      ))}
    </select>
  );
}
