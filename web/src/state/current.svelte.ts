// The machine that this screen shows, and what may be done with it.

import type { Action, Answer, MachineView } from '../api/types';
import { t } from '../i18n/index.svelte';
import { age, conditionOf, isLive, isMoving, isOld } from './condition';
import { live } from './live.svelte';
import { prefs } from './prefs.svelte';

class Current {
  readonly ids = $derived(Object.keys(live.document?.machines ?? {}));
  readonly id = $derived(this.ids.includes(prefs.machine) ? prefs.machine : (this.ids[0] ?? ''));
  readonly view = $derived<MachineView | undefined>(live.document?.machines[this.id]);
  readonly snapshot = $derived(this.view?.snapshot);
  readonly condition = $derived(conditionOf(this.view, live.connected, live.now_s));
  /** Positions and the rest on the screen are those of now. */
  readonly isLive = $derived(isLive(this.condition) && !isOld(this.view, live.now_s));
  readonly isMoving = $derived(isMoving(this.condition));
  readonly age_s = $derived(age(this.view, live.now_s));
  readonly axes = $derived([...(this.view?.limits?.axes ?? 'XYZ')]);
  readonly system = $derived(this.snapshot?.work_coordinate_system ?? 'G54');
  readonly programId = $derived(this.view?.program ?? '');
  readonly program = $derived(live.document?.programs[this.programId]);
  readonly job = $derived(this.view?.job);
  readonly jobRuns = $derived(
    !!this.job && ['Running', 'Holding', 'Held', 'Draining', 'Stopping'].includes(this.job.phase),
  );
  /** The job under way, or the last one if it was of the program that is loaded now. */
  readonly shownJob = $derived(
    this.jobRuns || (!!this.job?.program_id && this.job.program_id === this.programId) ? this.job : undefined,
  );
  /** Another screen has the jog. */
  readonly jogElsewhere = $derived(!!this.view?.jog?.lease && this.view.jog.lease !== live.client);

  /** Empty when it may be done now; else one sentence why not. */
  why(action: Action): string {
    if (!live.connected) return t('why.offline');
    if (!this.view) return t('why.noMachine');
    if (this.view.link.phase !== 'Ready') return this.view.link.sentence || t('why.noMachine');
    return this.view.can?.[action] ?? '';
  }

  do(command: string, more: object = {}): Promise<Answer> {
    return live.command(this.id, command, more);
  }
}

export const current = new Current();
