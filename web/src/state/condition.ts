// What the header may claim about a machine. Where Kerf does not know, it says that, and never the last thing it heard.

import type { MachineState, MachineView } from '../api/types';

export type Condition =
  | MachineState
  | 'Offline' // the server cannot be reached
  | 'NoMachine'
  | 'Off'
  | 'Opening'
  | 'Greeting'
  | 'Silent'
  | 'Lost'
  | 'Stale';

export const staleAfter_s = 2.5;

/** Seconds since the machine last told anything; undefined before it ever did. */
export function age(view: MachineView | undefined, now_s: number): number | undefined {
  const reported = view?.snapshot?.reported_at;
  return reported === undefined ? undefined : Math.max(0, now_s - reported);
}

export const isOld = (view: MachineView | undefined, now_s: number): boolean => (age(view, now_s) ?? 0) > staleAfter_s;

export function conditionOf(view: MachineView | undefined, connected: boolean, now_s: number): Condition {
  if (!connected) return 'Offline';
  if (!view) return 'NoMachine';
  if (view.link.phase !== 'Ready') return view.link.phase;
  const state = view.snapshot?.state ?? 'Unknown';
  // Many controllers say nothing while they home; the server knows when that is no longer it.
  if (state !== 'Home' && isOld(view, now_s)) return 'Stale';
  return state;
}

/** The state is one that the machine itself tells. */
export const isLive = (condition: Condition): boolean =>
  !['Offline', 'NoMachine', 'Off', 'Opening', 'Greeting', 'Silent', 'Lost', 'Stale', 'Unknown'].includes(condition);

/** The machine moves, or may at any moment. */
export const isMoving = (condition: Condition): boolean => ['Run', 'Jog', 'Home'].includes(condition);
