// The state document, followed by number: a snapshot sets it, patches (RFC 7396) move it on by one each.

import type { ServerFrame, StateDocument } from '../api/types';

export interface Followed {
  number: number;
  document: StateDocument | null;
}

export const nothingYet: Followed = { number: -1, document: null };

const isObject = (value: unknown): value is Record<string, unknown> =>
  typeof value === 'object' && value !== null && !Array.isArray(value);

/** A new value; what the patch does not touch is shared with the old one. */
export function mergePatch(target: unknown, patch: unknown): unknown {
  if (!isObject(patch)) return patch;
  const merged: Record<string, unknown> = isObject(target) ? { ...target } : {};
  for (const [key, value] of Object.entries(patch)) {
    if (value === null) delete merged[key];
    else merged[key] = mergePatch(merged[key], value);
  }
  return merged;
}

export type Outcome = { followed: Followed; gap: boolean };

/** `gap`: frames were missed; what we have is no longer true and a snapshot has to be asked for. */
export function follow(before: Followed, frame: ServerFrame): Outcome {
  if (frame.type === 'snapshot') return { followed: { number: frame.number, document: frame.state }, gap: false };
  if (frame.type !== 'patch') return { followed: before, gap: false };
  if (before.document !== null && frame.number <= before.number) return { followed: before, gap: false };
  if (before.document === null || frame.number !== before.number + 1) return { followed: before, gap: true };
  const document = mergePatch(before.document, frame.patch) as StateDocument;
  return { followed: { number: frame.number, document }, gap: false };
}
