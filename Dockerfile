FROM python:3.13-slim AS build
RUN pip install --no-cache-dir uv
ENV UV_PROJECT_ENVIRONMENT=/opt/venv UV_LINK_MODE=copy UV_NO_CACHE=1 UV_PYTHON_DOWNLOADS=never UV_COMPILE_BYTECODE=1
WORKDIR /srv/escape-explorer
# Without the sources first: a change in them alone does not fetch every package anew.
COPY pyproject.toml README.md LICENSE ./
RUN uv sync --no-dev --no-install-project
COPY engine engine
COPY app app
COPY cli cli
RUN uv sync --no-dev && /opt/venv/bin/python -m compileall -q app cli engine

FROM python:3.13-slim
COPY --from=build /opt/venv /opt/venv
COPY --from=build /srv/escape-explorer /srv/escape-explorer
# The sources are not the user's to write: compiled kernels go to a volume, and last as long as that.
RUN useradd --system --create-home explorer && install --directory --owner=explorer /var/cache/escape-explorer
ENV PATH=/opt/venv/bin:$PATH \
    PYTHONUNBUFFERED=1 \
    ESCAPE_EXPLORER_CACHE=/var/cache/escape-explorer \
    NUMBA_CACHE_DIR=/var/cache/escape-explorer/numba
# Whose pages may talk to this server besides its own, as behind a proxy that renames it: host:port, with commas between.
ENV BOKEH_ALLOW_WS_ORIGIN=localhost:5006,127.0.0.1:5006
WORKDIR /srv/escape-explorer
USER explorer
VOLUME /var/cache/escape-explorer
EXPOSE 5006
HEALTHCHECK --start-period=2m \
    CMD ["python", "-c", "from urllib.request import urlopen; urlopen('http://127.0.0.1:5006/liveness', timeout=10)"]
CMD ["panel", "serve", "app", "--address", "0.0.0.0", "--port", "5006", "--liveness"]
