"""Other people's data as datasets: one module a format, each with one ``import_…`` function.

Every function takes the files or folders to read, the folder to write, and the frame rate wanted.
"""
