// Files on their way to the library, how far each is, and what then.

import { upload } from '../api/http';
import { t } from '../i18n/index.svelte';
import { current } from '../state/current.svelte';
import { hint } from '../state/hints.svelte';

class Uploads {
  under = $state<{ id: number; name: string; share: number }[]>([]);
  private next = 1;

  async add(files: Iterable<File>): Promise<void> {
    for (const file of files) await this.one(file);
  }

  private async one(file: File): Promise<void> {
    const id = this.next++;
    this.under.push({ id, name: file.name, share: 0 });
    try {
      const made = await upload<{ id: string }>(`/programs?name=${encodeURIComponent(file.name)}`, file, (share) => {
        const shown = this.under.find((one) => one.id === id);
        if (shown) shown.share = share;
      });
      hint.say(t('upload.done', { name: file.name }));
      if (current.id && !current.jobRuns) await current.do('Load', { program: made.id });
    } catch (error) {
      hint.say(t('upload.failed', { name: file.name, why: (error as Error).message }), 'trouble');
    } finally {
      this.under = this.under.filter((one) => one.id !== id);
    }
  }
}

export const uploads = new Uploads();
