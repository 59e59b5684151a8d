// The press outside that closes a popover: its end, so that the field that was left has taken its text.
export const AFTER_FIELDS = ["mouseup"];
