// What is the matter, most urgent first: each is a state of its own that nobody can mistake for another.

import type { Action, MachineView } from '../api/types';
import type { MessageKey } from '../i18n/index.svelte';
import type { Condition } from '../state/condition';

export interface Way {
  label: MessageKey;
  command: string;
  action?: Action;
  more?: object;
  held?: boolean;
}

export interface Situation {
  id: string;
  level: 'trouble' | 'warning' | 'note';
  condition: Condition;
  /** Ours, to be translated; or the server's own words. */
  title: MessageKey | { told: string };
  text?: MessageKey | { told: string };
  values?: Record<string, string | number>;
  evidence?: string[];
  steps?: string[];
  ways?: Way[];
}

export interface Seen {
  view: MachineView | undefined;
  condition: Condition;
  age_s: number | undefined;
  jogElsewhere: boolean;
}

const linkTexts: Partial<Record<Condition, MessageKey>> = {
  Off: 'situation.off',
  Opening: 'situation.opening',
  Greeting: 'situation.greeting',
  Silent: 'situation.silent',
  Lost: 'situation.lost',
};

function link(view: MachineView, condition: Condition): Situation[] {
  const title = linkTexts[condition];
  if (!title) return [];
  const connect: Way[] = condition === 'Off' ? [{ label: 'way.connect', command: 'Connect' }] : [];
  const level = condition === 'Silent' || condition === 'Lost' ? 'trouble' : 'note';
  return [{ id: condition, level, condition, title, text: { told: view.link.sentence }, ways: connect }];
}

const isUnderWay = (view: MachineView): boolean =>
  !!view.job && ['Running', 'Holding', 'Held', 'Draining', 'Stopping'].includes(view.job.phase);

function trouble(view: MachineView, condition: Condition): Situation[] {
  const { trouble, snapshot } = view;
  const unlock: Way[] =
    condition === 'Alarm'
      ? [
          ...(snapshot?.reset_required ? [{ label: 'way.reset' as const, command: 'SoftReset' }] : []),
          { label: 'way.home', command: 'Home', action: 'home', held: true },
          { label: 'way.unlock', command: 'Unlock', action: 'unlock' },
        ]
      : [];
  // What a job waits for is over with the job.
  const isOver = trouble && ['Stall', 'OffPath'].includes(trouble.kind) && !isUnderWay(view);
  if (trouble && !isOver)
    return [
      {
        id: 'trouble',
        level: condition === 'Alarm' ? 'trouble' : 'warning',
        condition: condition === 'Alarm' ? 'Alarm' : 'Hold',
        title: { told: trouble.headline },
        evidence: trouble.evidence,
        steps: trouble.steps,
        ways: unlock,
      },
    ];
  if (condition !== 'Alarm') return [];
  const values = { code: snapshot?.alarm_code ?? '?' };
  return [
    {
      id: 'Alarm',
      level: 'trouble',
      condition,
      title: 'situation.alarm',
      text: 'situation.alarm.text',
      values,
      ways: unlock,
    },
  ];
}

function standing(view: MachineView, condition: Condition): Situation[] {
  const change = view.job?.phase === 'Held' ? view.job.tool_change : undefined;
  const resume: Way[] = [{ label: 'way.resume', command: 'Resume', action: 'resume', held: true }];
  const prompt = view.snapshot?.prompt;
  const evidence = prompt ? [prompt] : undefined;
  const found: Situation[] = [];
  if (condition === 'Door')
    found.push({
      id: 'Door',
      level: 'warning',
      condition,
      title: 'situation.door',
      text: 'situation.door.text',
      evidence,
      ways: resume,
    });
  if (condition === 'Tool' || change)
    found.push({
      id: 'Tool',
      level: 'warning',
      condition: 'Tool',
      title: change?.tool === undefined ? 'situation.tool' : 'situation.toolNumber',
      values: { tool: change?.tool ?? '' },
      text: 'situation.tool.text',
      evidence,
      ways: resume,
    });
  if (condition === 'Check')
    found.push({ id: 'Check', level: 'note', condition, title: 'situation.check', text: 'situation.check.text' });
  if (condition === 'Sleep')
    found.push({
      id: 'Sleep',
      level: 'note',
      condition,
      title: 'situation.sleep',
      text: 'situation.sleep.text',
      ways: [{ label: 'way.reset', command: 'SoftReset' }],
    });
  if (condition === 'Hold' && prompt && !change)
    found.push({ id: 'Hold', level: 'warning', condition, title: { told: prompt }, ways: resume });
  return found;
}

export function situationsOf({ view, condition, age_s, jogElsewhere }: Seen): Situation[] {
  if (condition === 'Offline')
    return [{ id: 'Offline', level: 'trouble', condition, title: 'situation.offline', text: 'situation.offline.text' }];
  if (!view)
    return [
      { id: 'NoMachine', level: 'note', condition, title: 'situation.noMachine', text: 'situation.noMachine.text' },
    ];
  const found = link(view, condition);
  if (found.length > 0) return found;
  if (condition === 'Stale')
    found.push({
      id: 'Stale',
      level: 'trouble',
      condition,
      title: 'situation.stale',
      text: 'situation.stale.text',
      values: { s: (age_s ?? 0).toFixed(0) },
    });
  found.push(...trouble(view, condition), ...standing(view, condition));
  if (view.snapshot?.pendant_in_control)
    found.push({
      id: 'Pendant',
      level: 'warning',
      condition: 'Hold',
      title: 'situation.pendant',
      text: 'situation.pendant.text',
      ways: [{ label: 'way.takeControl', command: 'TakeControl' }],
    });
  if (jogElsewhere)
    found.push({
      id: 'JogElsewhere',
      level: 'note',
      condition: 'Jog',
      title: 'situation.jogElsewhere',
      text: 'situation.jogElsewhere.text',
    });
  return found;
}
