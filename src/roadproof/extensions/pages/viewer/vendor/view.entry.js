// The libraries of the viewer and the studio: preact, signals, htm, uPlot.
import htm from "htm";
import { h } from "preact";

export { Component, createRef, h, render } from "preact";
export { useEffect, useLayoutEffect, useMemo, useRef, useState } from "preact/hooks";
export { batch, computed, effect, signal, useComputed, useSignal, useSignalEffect } from "@preact/signals";
export const html = htm.bind(h);
export { default as UPlot } from "uplot";
