// Keys that work on every page: Space holds and never starts; Escape lets go, and twice it stops the job.

import { current } from '../state/current.svelte';
import { live } from '../state/live.svelte';

const twiceWithin_ms = 1000;
let escapedAt = 0;

const isText = (target: EventTarget | null): boolean =>
  target instanceof HTMLElement && (target.isContentEditable || /^(TEXTAREA|INPUT|SELECT)$/.test(target.tagName));

function onKey(event: KeyboardEvent): void {
  if (event.repeat) return;
  if (event.code === 'Space' && !isText(event.target) && (current.isMoving || current.job?.phase === 'Running')) {
    event.preventDefault();
    event.stopPropagation();
    live.lease.release();
    void current.do('Hold');
  } else if (event.key === 'Escape') escape();
}

function escape(): void {
  live.lease.release();
  const twice = Date.now() - escapedAt < twiceWithin_ms;
  escapedAt = Date.now();
  if (current.condition === 'Jog') void current.do('CancelJog');
  else if (twice && current.jobRuns) void current.do('Stop');
}

export function listenToKeys(): () => void {
  window.addEventListener('keydown', onKey, true);
  return () => window.removeEventListener('keydown', onKey, true);
}
