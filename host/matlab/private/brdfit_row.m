function row = brdfit_row(name, values, count)
% BRDFIT_ROW  One number, or as many as there are samples, as a row.
    if ~isnumeric(values) || ~isreal(values) || isempty(values)
        error('brdfit:badInput', 'brdfit: %s must be an array of real numbers', name);
    end
    row = double(values(:).');
    if numel(row) == 1
        row = repmat(row, 1, count);
    elseif numel(row) ~= count
        error('brdfit:sizeMismatch', 'brdfit: %s has %d numbers, and there are %d samples', name, numel(row), count);
    end
end
