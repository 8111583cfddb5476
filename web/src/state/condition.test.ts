import { expect, it } from 'vitest';
import type { MachineView } from '../api/types';
import { situationsOf } from '../shell/situations';
import { conditionOf, isLive } from './condition';
import { endOf, lineAt } from './program.svelte';

const view = (more: Partial<MachineView> = {}): MachineView => ({
  name: 'm',
  url: 'virtual:grblhal',
  link: { phase: 'Ready', sentence: 'It is idle.' },
  snapshot: { state: 'Idle', reported_at: 100 },
  ...more,
});

it('claims a state only as long as it was heard', () => {
  expect(conditionOf(view(), true, 100.5)).toBe('Idle');
  expect(conditionOf(view(), true, 110)).toBe('Stale');
  expect(conditionOf(view({ snapshot: { state: 'Home', reported_at: 100 } }), true, 110)).toBe('Home');
  expect(conditionOf(view(), false, 100.5)).toBe('Offline');
  expect(conditionOf(undefined, true, 0)).toBe('NoMachine');
  expect(conditionOf(view({ link: { phase: 'Lost', sentence: '' } }), true, 100)).toBe('Lost');
  for (const one of ['Offline', 'Stale', 'Lost', 'Silent', 'Unknown'] as const) expect(isLive(one)).toBe(false);
});

it('each trouble is a situation of its own', () => {
  const ids = (more: Partial<MachineView>, condition = conditionOf(view(more), true, 100)) =>
    situationsOf({ view: view(more), condition, age_s: 0, jogElsewhere: false }).map((one) => one.id);
  expect(ids({})).toEqual([]);
  expect(ids({ snapshot: { state: 'Alarm', alarm_code: 1, reported_at: 100 } })).toEqual(['Alarm']);
  expect(ids({ snapshot: { state: 'Door', reported_at: 100 } })).toEqual(['Door']);
  expect(ids({ snapshot: { state: 'Check', reported_at: 100 } })).toEqual(['Check']);
  expect(ids({ snapshot: { state: 'Tool', reported_at: 100 } })).toEqual(['Tool']);
  expect(ids({ snapshot: { state: 'Idle', pendant_in_control: true, reported_at: 100 } })).toEqual(['Pendant']);
  expect(ids({ link: { phase: 'Lost', sentence: 'gone' } })).toEqual(['Lost']);
  expect(ids({}, 'Offline')).toEqual(['Offline']);
  expect(ids({}, 'Stale')).toEqual(['Stale']);
});

it('finds lines by time and times by line', () => {
  const timeline = { lines: [3, 5, 9], end_s: [1, 2, 4] };
  expect([0, 1, 1.5, 3, 99].map((s) => lineAt(timeline, s))).toEqual([3, 3, 5, 9, 9]);
  expect([1, 3, 6, 9, 20].map((line) => endOf(timeline, line))).toEqual([0, 1, 2, 4, 4]);
});
