// Names of the server's enums in the language of this screen; what we have no word for is shown as it came.

import type { JobView } from '../api/types';
import { en } from '../i18n/en';
import { t, type MessageKey } from '../i18n/index.svelte';

export function word(group: string, name: string): string {
  const key = `${group}.${name}`;
  return key in en ? t(key as MessageKey) : name;
}

/** A job that stands says why. */
export function phaseWord(job: JobView): string {
  if (job.phase === 'Held' && job.hold_cause !== 'None') return word('cause', job.hold_cause);
  return word('phase', job.phase);
}
