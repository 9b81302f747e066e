// @ts-check
import js from "@eslint/js"

export default [
  js.configs.recommended,
  {
    // TypeScript knows what is defined.
    rules: {
      "no-undef": "off",
      "no-unused-vars": ["error", {argsIgnorePattern: "^_", varsIgnorePattern: "^_"}],
      "eqeqeq": "error",
      "no-var": "error",
      "prefer-const": "error",
    },
  },
]
