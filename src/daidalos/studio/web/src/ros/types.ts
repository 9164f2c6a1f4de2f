// What messages and services have in common; the types themselves are generated.
import type { Header } from "../generated/std_msgs";

export interface Stamped {
  header: Header;
}

export interface ServiceType {
  Request: unknown;
  Response: unknown;
}

/** A message to be sent: fields that are left out get their defaults, and arrays of numbers may be plain ones. */
export type Outgoing<T> = T extends ArrayBufferView
  ? T | readonly number[]
  : T extends readonly (infer Item)[]
    ? readonly Outgoing<Item>[]
    : T extends object
      ? { readonly [Key in keyof T]?: Outgoing<T[Key]> }
      : T;
