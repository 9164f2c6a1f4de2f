// Signals whose values outlive the page: kept in the browser's local storage under one prefix.
import { effect, signal, type Signal } from "@preact/signals";

const PREFIX = "daidalos.";

export function stored<T>(key: string, initial: T, isValid: (value: unknown) => value is T): Signal<T> {
  const kept = signal(read(key, initial, isValid));
  let first = true;
  effect(() => {
    const value = kept.value;
    if (first) {
      first = false;
    } else {
      write(key, value);
    }
  });
  return kept;
}

export function read<T>(key: string, initial: T, isValid: (value: unknown) => value is T): T {
  try {
    const text = localStorage.getItem(PREFIX + key);
    const value: unknown = text === null ? undefined : JSON.parse(text);
    return isValid(value) ? value : initial;
  } catch {
    // Storage may be forbidden, and what it holds may come from another version: the page works without.
    return initial;
  }
}

export function write(key: string, value: unknown): void {
  try {
    localStorage.setItem(PREFIX + key, JSON.stringify(value));
  } catch {
    // Full or forbidden: nothing is kept, nothing else suffers.
  }
}

export function forget(key: string): void {
  try {
    localStorage.removeItem(PREFIX + key);
  } catch {
    // Forbidden: then nothing was kept either.
  }
}

export const isString = (value: unknown): value is string => typeof value === "string";
export const isRecord = (value: unknown): value is Record<string, unknown> =>
  typeof value === "object" && value !== null && !Array.isArray(value);
