// Jogging from this screen, whatever it is asked by: touch, keys, gamepad. One press at a time.

import type { AxisDirection } from '../api/types';
import { fromShown } from '../format/numbers';
import { hint } from '../state/hints.svelte';
import { current } from '../state/current.svelte';
import { live } from '../state/live.svelte';
import { prefs } from '../state/prefs.svelte';

/** The feeds to choose from: up to what the fastest axis can. */
export function feeds(): number[] {
  const most = Math.max(...(current.view?.limits?.max_feed_mm_per_min ?? [3000]));
  return [...[100, 500, 1000, 3000].filter((feed) => feed < most), most];
}

/** The chosen one; on a slower machine the nearest below. */
export const chosenFeed = (): number => feeds().findLast((feed) => feed <= prefs.jogFeed) ?? feeds()[0] ?? 100;

const step_mm = (): number => (prefs.units === 'inch' ? fromShown(prefs.jogStep_inch, 'inch') : prefs.jogStep_mm);

/** As fast as the slowest axis that takes part may go. */
function feedFor(direction: AxisDirection, wanted: number): number {
  const most = current.axes.map((axis, at) =>
    direction[axis] ? current.view?.limits?.max_feed_mm_per_min?.[at] : undefined,
  );
  return Math.min(wanted, ...most.filter((feed) => feed !== undefined));
}

export function press(direction: AxisDirection, feed = chosenFeed()): void {
  const why = current.why('jog');
  if (why) return hint.say(why);
  live.jog({ machine: current.id, direction, feed_mm_per_min: feedFor(direction, feed) });
}

export const release = (): void => live.lease.release();

export function step(direction: AxisDirection): void {
  const why = current.why('jog');
  if (why) return hint.say(why);
  const distance = Object.fromEntries(Object.entries(direction).map(([axis, sign]) => [axis, (sign ?? 0) * step_mm()]));
  void current.do('JogStep', { distance, feed_mm_per_min: feedFor(direction, chosenFeed()) });
}

/** Everything that takes the screen or the hand away lets go. */
export function letGoWithTheScreen(): () => void {
  const hidden = () => document.visibilityState !== 'visible' && release();
  window.addEventListener('blur', release);
  window.addEventListener('pagehide', release);
  document.addEventListener('visibilitychange', hidden);
  document.addEventListener('freeze', release);
  return () => {
    window.removeEventListener('blur', release);
    window.removeEventListener('pagehide', release);
    document.removeEventListener('visibilitychange', hidden);
    document.removeEventListener('freeze', release);
  };
}
