"""The studio's server: it runs the open document and shows it to the pages of browsers.

Folders, each of which imports only those before it:

`live` the engine, a session in a thread of its own, `messages` what is sent, `access` who may connect,
`files` the root folder and the state folder, `catalogue` examples, templates and plots, `views` documents
as messages, `streams` frames of arrays, `world` what the document senses and moves, `project` the open
document, `field_analysis` regime and tuning of a field, `experiment` the open experiment, `pages` the pages
and what they share, `requests` the requests of a page, `web` the application, `commands` the command
that starts it.
"""
