"""Outcomes in Home Assistant, over MQTT: totals of days, places, what is in use, goals, the floor's
map, and the other way round a button and a switch."""
