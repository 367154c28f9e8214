"""The hub of a site: a Zenoh router that lets each member do what its role needs, and no more.

``site_folder`` makes certificates (``certificates``) and the list of members (``members``),
``access`` says what a member may do, and ``service`` runs the router by both.
"""
