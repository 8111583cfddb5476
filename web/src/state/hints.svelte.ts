// Short sentences at the edge of the page: why something was not done.

import type { Answer } from '../api/types';
import { t } from '../i18n/index.svelte';

const shownFor_ms = 6000;

class Hints {
  shown = $state<{ id: number; text: string; level: 'note' | 'trouble' }[]>([]);
  private next = 1;

  say(text: string, level: 'note' | 'trouble' = 'note'): void {
    const id = this.next++;
    this.shown = [...this.shown.filter((one) => one.text !== text), { id, text, level }].slice(-3);
    setTimeout(() => this.close(id), shownFor_ms);
  }

  refused(answer: Answer): void {
    const ours: Record<string, string> = {
      NotConnected: t('hint.notConnected'),
      NoAnswer: t('hint.noAnswer'),
      Lost: t('hint.noAnswer'),
    };
    this.say(answer.sentence || ours[answer.reason ?? ''] || t('hint.refused'), 'trouble');
  }

  close(id: number): void {
    this.shown = this.shown.filter((one) => one.id !== id);
  }
}

export const hint = new Hints();
