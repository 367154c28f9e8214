"""The pages of a studio.

A page is a package with a module ``page`` that has ``open_page(visit) -> Page``: it adds what it
needs to ``visit.client.gui`` (it is inside a folder of the panel then) and to
``visit.client.scene``, and returns what is closed when the tab shows another page or is gone.
"""

PAGES = {
    "Live": "inhand_studio.live_page.page",
    "Review": "inhand_studio.review_page.page",
    "Label": "inhand_studio.labelling_page.page",
    "Record": "inhand_studio.recording_page.page",
    "Train": "inhand_studio.training_page.page",
    "Objects": "inhand_studio.objects_page.page",
}
