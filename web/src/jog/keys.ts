// Keys of the armed keyboard: which way, from all that are down at once.

import type { AxisDirection } from '../api/types';

const ways: Record<string, [string, number]> = {
  ArrowLeft: ['X', -1],
  ArrowRight: ['X', 1],
  ArrowDown: ['Y', -1],
  ArrowUp: ['Y', 1],
  PageDown: ['Z', -1],
  PageUp: ['Z', 1],
  Numpad4: ['X', -1],
  Numpad6: ['X', 1],
  Numpad2: ['Y', -1],
  Numpad8: ['Y', 1],
  Numpad3: ['Z', -1],
  Numpad9: ['Z', 1],
};

export const isJogKey = (code: string): boolean => code in ways;

/** Opposite keys cancel each other out; nothing left is undefined. */
export function directionOf(down: Iterable<string>): AxisDirection | undefined {
  const direction: Record<string, number> = {};
  for (const code of down) {
    const way = ways[code];
    if (way) direction[way[0]] = (direction[way[0]] ?? 0) + way[1];
  }
  const moving = Object.entries(direction).filter(([, value]) => value !== 0);
  return moving.length > 0 ? Object.fromEntries(moving.map(([axis, value]) => [axis, Math.sign(value)])) : undefined;
}

export const sameDirection = (a: AxisDirection | undefined, b: AxisDirection | undefined): boolean =>
  JSON.stringify(a) === JSON.stringify(b);
