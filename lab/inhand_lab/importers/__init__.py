"""Other people's data as datasets: one module a format, each with one ``import_…`` function.

The functions are alike: the files or folders to read, the folder to write, the frame rate wanted.
"""
