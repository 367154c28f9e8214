"""The words that `inhand outcomes` answers, with what each does."""

COMMANDS = {
    "today": "what was done today, and last",
    "history": "what was done in the last days",
    "where": "where an object was seen last",
    "forget": "remove what a person did, a day, or all that is kept",
}
