// The typeface of the page, its canvases and its exported pictures. Where a picture is opened without it, the
// sans serif of the system has the names.

export const TYPEFACE = '"Inter Variable", Inter, system-ui, sans-serif';
