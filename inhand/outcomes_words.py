"""The words that `inhand outcomes` answers from what is kept, and those that running daemons are
asked, with what each does."""

COMMANDS = {
    "today": "what was done today, and last",
    "history": "what was done in the last days",
    "where": "where an object was seen last",
    "forget": "remove what a person did, a day, or all that is kept",
}
ASKED = {
    "pause": "measure nothing until resume, over restarts too",
    "resume": "measure again",
}
