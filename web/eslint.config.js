import svelte from 'eslint-plugin-svelte';
import ts from 'typescript-eslint';

export default ts.config(
  { ignores: ['dist/', 'node_modules/'] },
  ...ts.configs.recommended,
  ...svelte.configs.recommended,
  { files: ['**/*.svelte', '**/*.svelte.ts'], languageOptions: { parserOptions: { parser: ts.parser } } },
  { rules: { 'max-lines': ['error', 250] } },
  { files: ['src/i18n/{en,de}.ts', 'src/api/types.ts'], rules: { 'max-lines': 'off' } },
);
