"""The contract between Inhand's processes: messages, keys, delivery and codec.

Everything that crosses a wire or stands in a recording is defined here, and nothing here
knows Zenoh or MCAP.
"""
