"""The gate before the studio's pages, whose own server knows neither users nor encryption.

``gate`` listens where the settings say and forwards to one server on this machine whose address
nobody else is told. It asks who is asking (``hosts``, ``password``, ``sessions``), encrypts
(``certificate``), and lets the pages ask nothing of other machines (``headers``).
"""
