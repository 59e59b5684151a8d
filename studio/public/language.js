// Under the locale C some browsers (WebKitGTK) say that the language is "C", which is none: libraries that
// format numbers for it fail when they are loaded, and the page stays blank. This runs before them.
try {
  Intl.NumberFormat.supportedLocalesOf(navigator.language);
} catch {
  Object.defineProperty(navigator, "language", { value: "en", configurable: true });
}
