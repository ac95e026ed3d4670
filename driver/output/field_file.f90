!> Fields over time, of a chain or a fault, in one format: BASE_fields_000001.h5 and so on hold a
!> number of records each, as data sets `time` and one for each field (record, row, column), and
!> BASE_fields.h5 shows them as one (virtual data sets). Without HDF5 the parts are
!> BASE_fields_000001.bin.
!>
!> A part is written whole, under another name, before it takes the place of the one before: a run
!> that is killed leaves all that it had saved, and readable. The last part is written again as it
!> grows. Any number of processes share the rows. What they have to do one after the other, all of
!> them or the first alone, is told at each procedure; a chain has one process.
module field_file
    use, intrinsic :: iso_c_binding, only : c_char, c_int64_t, c_null_char
    use, intrinsic :: iso_fortran_env, only : dp => real64, int64
    use field_layouts, only : field_layout, fields_are_hdf5, find_fields, get_numbers, &
        join_fields, lay_out_fields, most_fields, name_length, put_numbers, word
    use platform, only : remove_file, rename_file
    implicit none
    private

    public :: field_parts, field_record_bytes, whole_words

    integer(int64), parameter :: part_bytes = 16777216_int64   !! of a part, about

    type :: field_parts
        character(len=:), allocatable :: base   !! of the files' names, with the directory
        integer(int64) :: records = 0           !! so far
        integer(int64) :: saved = 0             !! of them, in files
        logical :: failed = .false.             !! something could not be written or read
        integer(c_int64_t) :: places(0:most_fields) = 0   !! of times and fields in a part [bytes]
        real(dp), allocatable :: times(:)       !! of all records, as the first process knows them
        type(field_layout), private :: layout
        real(dp), allocatable, private :: axes(:)            !! places of rows, then of columns
        integer(int64), private :: cells_before = 0          !! those of this process
        integer(int64), private :: part_of_places = 0        !! that `places` are of
        integer(int64), private :: per_part = 1              !! records
        real(dp), allocatable, private :: values(:, :, :)    !! own cell, record of the part, field
    contains
        procedure :: prepare, take_rows, next, put
        procedure :: is_full, is_saved, lay_out, write_own, publish, withdraw
        procedure :: count_saved, find, read_own, read_record, data_item, last_together
        procedure, private :: part_name, parts, records_of, find_part
    end type field_parts

contains

    pure integer(int64) function field_record_bytes(cells, fields) result(bytes)
        integer(int64), intent(in) :: cells
        integer, intent(in) :: fields

        bytes = word * (1 + fields * cells)
    end function field_record_bytes

    !> For files BASE_fields*, of fields on cells at these places of rows and columns.
    subroutine prepare(self, base, fields, axes, rows, columns)
        class(field_parts), intent(out) :: self
        character(len=*), intent(in) :: base
        character(len=*), intent(in) :: fields(:)    !! names, up to 15 letters
        character(len=*), intent(in) :: axes(2)      !! names of rows and columns
        real(dp), intent(in) :: rows(:)              !! places
        real(dp), intent(in) :: columns(:)           !! one column is none
        integer :: i

        self%base = base
        self%layout%rows = size(rows)
        self%layout%columns = size(columns)
        self%layout%fields = size(fields)
        do i = 1, size(fields)
            self%layout%names(:, i) = letters(fields(i))
        end do
        do i = 1, 2
            self%layout%axes(:, i) = letters(axes(i))
        end do
        self%axes = [rows, columns]
        self%per_part = max(1_int64, part_bytes / field_record_bytes(size(rows, kind=int64) &
            * size(columns), size(fields)))
        allocate (self%times(64))
        call self%take_rows(1, size(rows))
    end subroutine prepare

    !> The rows of this process, if it is not the only one.
    subroutine take_rows(self, first, rows)
        class(field_parts), intent(inout) :: self
        integer, intent(in) :: first, rows

        if (allocated(self%values)) deallocate (self%values)
        allocate (self%values(rows * self%layout%columns, self%per_part, self%layout%fields))
        self%cells_before = (first - 1) * self%layout%columns
    end subroutine take_rows

    ! ---- records -----------------------------------------------------------------------------

    !> Begins a record; `put` gives it its fields. A full part must have been saved.
    subroutine next(self, time)
        class(field_parts), intent(inout) :: self
        real(dp), intent(in) :: time

        if (self%records == size(self%times)) self%times = [self%times, self%times]   ! room
        self%records = self%records + 1
        self%times(self%records) = time
    end subroutine next

    !> A field of the record that was begun, on the cells of this process.
    subroutine put(self, field, values)
        class(field_parts), intent(inout) :: self
        integer, intent(in) :: field        !! 1 for the first one
        real(dp), intent(in) :: values(:)

        self%values(:, self%records_of(self%parts()), field) = values
    end subroutine put

    !> Must records be saved before another one begins?
    pure logical function is_full(self) result(full)
        class(field_parts), intent(in) :: self

        full = .not. self%is_saved() .and. mod(self%records, self%per_part) == 0
    end function is_full

    pure logical function is_saved(self) result(saved)
        class(field_parts), intent(in) :: self

        saved = self%saved == self%records
    end function is_saved

    ! ---- saving the last part: lay out, write, publish ---------------------------------------

    !> Makes the new file, and knows the places in it (first process).
    subroutine lay_out(self)
        class(field_parts), intent(inout) :: self

        self%layout%records = self%records_of(self%parts())
        self%failed = lay_out_fields(self%part_name(self%parts()) // '.new' // c_null_char, &
            self%layout, self%places) /= 0
        self%part_of_places = 0
    end subroutine lay_out

    !> Writes the numbers of this process (all processes, once they know the places).
    subroutine write_own(self)
        class(field_parts), intent(inout) :: self
        character(len=:), allocatable :: file
        integer(int64) :: n, first, own, all_cells
        integer :: k
        logical :: bad

        file = self%part_name(self%parts()) // '.new' // c_null_char
        n = self%records_of(self%parts())
        first = self%records - n + 1
        own = size(self%values, 1)
        all_cells = self%layout%rows * self%layout%columns
        bad = .false.
        if (self%cells_before == 0) bad = put_numbers(file, self%places(0), 0_int64, 1_int64, n, &
            self%times(first:self%records)) /= 0
        do k = 1, int(self%layout%fields)
            if (own == 0 .or. bad) exit
            if (own == all_cells) then
                bad = put_numbers(file, self%places(k), 0_int64, 1_int64, n * own, &
                    self%values(:, :, k)) /= 0
            else
                bad = put_numbers(file, self%places(k) + word * self%cells_before, &
                    word * all_cells, n, own, self%values(:, :, k)) /= 0
            end if
        end do
        self%failed = bad
    end subroutine write_own

    !> Gives the new file its name, and joins it to the others (first process, once all have
    !> written).
    subroutine publish(self)
        class(field_parts), intent(inout) :: self
        type(field_layout) :: whole
        character(len=:), allocatable :: names, file
        integer(int64) :: i, length, n

        n = self%parts()
        file = self%part_name(n)
        self%failed = .not. rename_file(file // '.new', file)
        if (self%failed) return
        if (fields_are_hdf5() == 0) return
        length = len(file_name(file)) + 1   ! with the null at its end
        allocate (character(len=n * length) :: names)
        do i = 1, n
            names((i - 1) * length + 1:i * length) = file_name(self%part_name(i)) // c_null_char
        end do
        whole = self%layout
        whole%records = self%records
        file = self%base // '_fields.h5'
        self%failed = join_fields(file // '.new' // c_null_char, whole, names, length, &
            self%per_part, self%axes) /= 0
        if (.not. self%failed) self%failed = .not. rename_file(file // '.new', file)
    end subroutine publish

    !> Leaves nothing of a part that could not be written whole (first process).
    subroutine withdraw(self)
        class(field_parts), intent(in) :: self

        call remove_file(self%part_name(self%parts()) // '.new')
    end subroutine withdraw

    ! ---- going on with the files of a run that was stopped -----------------------------------

    !> Records in the files that are there, as a run has left them.
    integer(int64) function count_saved(self) result(records)
        class(field_parts), intent(inout) :: self
        integer(int64) :: part
        logical :: there

        records = 0
        part = 1
        do
            inquire (file=self%part_name(part), exist=there)
            if (.not. there) exit
            call self%find_part(part)
            if (self%failed) exit
            records = records + self%layout%records
            part = part + 1
        end do
    end function count_saved

    !> Finds the last part again, and the times of all records (first process).
    subroutine find(self, records)
        class(field_parts), intent(inout) :: self
        integer(int64), intent(in) :: records
        integer(int64) :: part, first, n

        self%records = records
        deallocate (self%times)
        allocate (self%times(2 * records))
        do part = 1, self%parts()
            n = self%records_of(part)
            first = (part - 1) * self%per_part + 1
            call self%find_part(part)
            if (self%layout%records < n) self%failed = .true.
            if (self%failed) return
            self%failed = get_numbers(self%part_name(part) // c_null_char, self%places(0), &
                0_int64, 1_int64, n, self%times(first:first + n - 1)) /= 0
        end do
    end subroutine find

    !> Takes the records of the last part back (all processes, once they know the places).
    subroutine read_own(self, records)
        class(field_parts), intent(inout) :: self
        integer(int64), intent(in) :: records
        integer(int64) :: n
        integer :: k

        self%records = records
        self%saved = records
        if (size(self%times) < records) self%times = spread(0.0_dp, 1, int(2 * records))
        n = self%records_of(self%parts())
        if (size(self%values, 1) == 0) return
        do k = 1, int(self%layout%fields)
            if (get_numbers(self%part_name(self%parts()) // c_null_char, self%places(k) + word &
                * self%cells_before, word * self%layout%rows * self%layout%columns, n, &
                size(self%values, 1, int64), self%values(:, :, k)) /= 0) self%failed = .true.
        end do
    end subroutine read_own

    ! ---- reading, description ----------------------------------------------------------------

    !> A field of one record, of all cells.
    subroutine read_record(self, record, field, values)
        class(field_parts), intent(inout) :: self
        integer(int64), intent(in) :: record
        integer, intent(in) :: field
        real(dp), intent(out) :: values(:)
        integer(int64) :: part

        part = (record - 1) / self%per_part + 1
        call self%find_part(part)
        if (.not. self%failed) self%failed = get_numbers(self%part_name(part) // c_null_char, &
            self%places(field) + word * size(values) * mod(record - 1, self%per_part), 0_int64, &
            1_int64, size(values, kind=int64), values) /= 0
    end subroutine read_record

    !> Places in a part, as its file has them.
    subroutine find_part(self, part)
        class(field_parts), intent(inout) :: self
        integer(int64), intent(in) :: part

        if (self%part_of_places == part) return
        self%part_of_places = part
        self%failed = find_fields(self%part_name(part) // c_null_char, self%layout, self%places) &
            /= 0
    end subroutine find_part

    !> The last of those records from `first` on that one data item of a description can take.
    integer(int64) function last_together(self, first) result(last)
        class(field_parts), intent(in) :: self
        integer(int64), intent(in) :: first

        last = self%saved
        if (fields_are_hdf5() == 0) last = min(last, first + self%per_part - 1 - mod(first - 1, &
            self%per_part))
    end function last_together

    !> XDMF's words for a field of records from `first` on; field 0 are their times.
    function data_item(self, field, first, n) result(text)
        class(field_parts), intent(inout) :: self
        integer, intent(in) :: field
        integer(int64), intent(in) :: first, n
        character(len=:), allocatable :: text
        integer(int64) :: part, shape(3), cells
        integer :: rank, outer

        shape = [n, self%layout%rows, self%layout%columns]
        rank = merge(3, 2, self%layout%columns > 1)
        if (field == 0) rank = 1
        outer = merge(2, 1, n == 1 .and. field > 0)   ! one record is a map, not a pile of one
        text = '" NumberType="Float" Precision="8" Format="'
        if (fields_are_hdf5() /= 0) then
            text = '<DataItem ItemType="HyperSlab" Dimensions="' &
                // whole_words(shape(outer:rank)) // '"><DataItem Dimensions="3 ' &
                // whole_words([int(rank, int64)]) // '" Format="XML">' &
                // whole_words([first - 1, 0_int64 * shape(2:rank), 0_int64 * shape(:rank) + 1, &
                shape(:rank)]) // '</DataItem><DataItem Dimensions="' &
                // whole_words([self%saved, shape(2:rank)]) // text // 'HDF">' &
                // file_name(self%base) // '_fields.h5:/' // field_name(self, field) &
                // '</DataItem></DataItem>'
        else
            part = (first - 1) / self%per_part + 1
            call self%find_part(part)
            cells = merge(1_int64, shape(2) * shape(3), field == 0)
            text = '<DataItem Dimensions="' // whole_words(shape(outer:rank)) // text &
                // 'Binary" Endian="Little" Seek="' // whole_words([self%places(field) + word &
                * cells * mod(first - 1, self%per_part)]) // '">' &
                // file_name(self%part_name(part)) // '</DataItem>'
        end if
    end function data_item

    pure function field_name(self, field) result(text)
        type(field_parts), intent(in) :: self
        integer, intent(in) :: field
        character(len=:), allocatable :: text

        text = 'time'
        if (field == 0) return
        text = transfer(self%layout%names(:, field), repeat(' ', name_length))
        text = text(:index(text, c_null_char) - 1)
    end function field_name

    ! ---- names and numbers -------------------------------------------------------------------

    !> Parts of all records.
    pure integer(int64) function parts(self) result(n)
        class(field_parts), intent(in) :: self

        n = (self%records - 1) / self%per_part + 1
    end function parts

    !> Records of a part.
    pure integer(int64) function records_of(self, part) result(n)
        class(field_parts), intent(in) :: self
        integer(int64), intent(in) :: part

        n = min(self%per_part, self%records - (part - 1) * self%per_part)
    end function records_of

    function part_name(self, part) result(name)
        class(field_parts), intent(in) :: self
        integer(int64), intent(in) :: part
        character(len=:), allocatable :: name
        character(len=20) :: number

        write (number, '(i6.6)') part
        name = self%base // '_fields_' // trim(number) // merge('.h5 ', '.bin', &
            fields_are_hdf5() /= 0)
        name = trim(name)
    end function part_name

    pure function file_name(path) result(name)
        character(len=*), intent(in) :: path
        character(len=:), allocatable :: name

        name = path(index(path, '/', back=.true.) + 1:)
    end function file_name

    pure function letters(name) result(all_letters)
        character(len=*), intent(in) :: name   !! shorter than that
        character(kind=c_char) :: all_letters(name_length)
        character(len=name_length) :: ended

        ended = trim(name) // repeat(c_null_char, name_length)
        all_letters = transfer(ended, all_letters)
    end function letters

    !> Whole numbers as words of XDMF.
    pure function whole_words(numbers) result(text)
        integer(int64), intent(in) :: numbers(:)
        character(len=:), allocatable :: text
        character(len=240) :: words

        write (words, '(*(i0, :, 1x))') numbers
        text = trim(words)
    end function whole_words

end module field_file
