import { expect, it } from "vitest";
import { emptyMessage, makeReader, makeWriter } from "../connection/codecs";
import { fromText, toText } from "./text";

const DEFINITION = "int64 count\nfloat64[2] range\nuint8[] data\nstring name 'nobody'\nbool on";

it("shows what a definition gives by itself", () => {
  expect(fromText(toText(emptyMessage(DEFINITION)))).toEqual({
    count: 0,
    range: [0, 0],
    data: [],
    name: "nobody",
    on: false,
  });
});

it("gives back what was edited", () => {
  const edited = { count: 12, range: [1, 2], data: [3], name: "me", on: true };
  const message = makeReader(DEFINITION)(makeWriter(DEFINITION)(fromText(toText(edited))));
  expect(fromText(toText(message))).toEqual(edited);
});

it("keeps integers that JavaScript's numbers cannot hold", () => {
  expect(fromText(toText({ large: 2n ** 63n - 1n }))).toEqual({ large: "9223372036854775807" });
});
