// The page's service worker: what cannot be fetched comes from the cache that keepOffline() of main.js fills.
addEventListener('fetch', (event) => {
    if (event.request.method === 'GET') {
        event.respondWith(fetch(event.request).catch(async (error) => {
            const kept = await caches.match(event.request, { ignoreSearch: true });
            if (kept === undefined) {
                throw error;
            }
            return kept;
        }));
    }
});
