"""Pictures, seconds and memory beside other tools and published tables: ``python -m benchmarks`` (``make bench``)."""
